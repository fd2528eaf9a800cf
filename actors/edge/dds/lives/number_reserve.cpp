#include "actors/edge/dds/lives/number_reserve.hpp"

#include "actors/edge/dds/rtps/rtps_messages.hpp"
#include "actors/edge/disk/small_file.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <utility>

namespace roscell {

namespace {

/// Where nothing is known of earlier lives numbers begin above what they are
/// likely to have used.
constexpr std::int64_t sequences_of_many = 1 << 17;
constexpr std::int64_t sequences_of_few = 1 << 12;
constexpr std::int64_t unknown_counts = 1 << 20;

/// Counts have 31 bits on the wire, and must not begin anew within a life.
constexpr std::int64_t highest_of_counts =
    std::numeric_limits<std::int32_t>::max() / 2;

bool is_sane(std::int64_t sequences, std::int64_t counts) {
  constexpr std::int64_t most = std::int64_t{1} << 40;
  return sequences >= 0 && sequences < most && counts >= 0
         && counts < highest_of_counts;
}

} // namespace

number_reserve::number_reserve(
    std::filesystem::path file,
    std::function<void(const std::string&)> on_problem, former_lives before)
    : file_(std::move(file)), on_problem_(std::move(on_problem)) {
  read(before);
}

std::int64_t number_reserve::begin_life() {
  std::lock_guard<std::mutex> lock{mutex_};
  const auto result = sequences_end_.load();
  highest_sequence_ = result;
  highest_count_ = counts_end_.load();
  write();
  return result;
}

void number_reserve::use_sequence(std::int64_t number) {
  if (number > sequences_end_ - sequence_block / 2) {
    std::lock_guard<std::mutex> lock{mutex_};
    highest_sequence_ = std::max(highest_sequence_.load(), number);
    if (number > sequences_end_ - sequence_block / 2)
      write();
  }
}

std::uint32_t number_reserve::next_count() {
  const auto result = ++highest_count_;
  if (result > counts_end_ - count_block / 2) {
    std::lock_guard<std::mutex> lock{mutex_};
    if (result > counts_end_ - count_block / 2)
      write();
  }
  return static_cast<std::uint32_t>(result);
}

void number_reserve::read(former_lives before) {
  if (file_.empty())
    return;
  std::ifstream in{file_};
  std::int64_t sequences = -1;
  std::int64_t counts = -1;
  in >> sequences >> counts;
  if (!in || !is_sane(sequences, counts)) {
    sequences =
        before == former_lives::many ? sequences_of_many : sequences_of_few;
    counts = unknown_counts;
  }
  sequences_end_ = sequences;
  counts_end_ = counts;
}

/// Sets the next blocks aside.
void number_reserve::write() {
  sequences_end_ = highest_sequence_ + sequence_block;
  counts_end_ = highest_count_ + count_block;
  if (file_.empty())
    return;
  const auto why =
      write_lasting(file_, std::to_string(sequences_end_) + ' '
                               + std::to_string(counts_end_) + '\n');
  if (!why.empty() && on_problem_)
    on_problem_(why);
}

namespace {

constexpr std::size_t endpoints_bytes = 8; // Reader and writer.
constexpr std::uint32_t bits_a_word = 32;

std::int64_t raise_data(const submessage_view& x, const guid_prefix& self,
                        std::int64_t by) {
  auto at = x.body;
  at.skip(4 + endpoints_bytes);
  const auto result = raise_number(at, by);
  if ((x.flags & submessage_flag::inline_qos) != 0)
    raise_identity(at, self, by);
  return result;
}

std::int64_t raise_heartbeat(const submessage_view& x, std::int64_t by,
                             std::uint32_t count) {
  auto at = x.body;
  at.skip(endpoints_bytes);
  raise_number(at, by);
  const auto result = raise_number(at, by);
  if (at.size() >= 4)
    put_word(at, count);
  return result;
}

/// The last number that a gap skips may be named bit by bit.
std::int64_t raise_gap(const submessage_view& x, std::int64_t by) {
  auto at = x.body;
  at.skip(endpoints_bytes);
  raise_number(at, by);
  return raise_number(at, by);
}

/// The bits of a set whose base gets lower, or is lost with those below `from`.
void move_bits(wire_cursor words, std::uint32_t bits, std::uint32_t lost) {
  const auto is_set = [&](std::uint32_t i) {
    auto word = words;
    word.skip(std::size_t{i / bits_a_word} * 4);
    return (word.u32() >> (bits_a_word - 1 - i % bits_a_word) & 1U) != 0;
  };
  for (std::uint32_t first = 0; first < bits; first += bits_a_word) {
    std::uint32_t value = 0;
    for (std::uint32_t i = first; i < first + bits_a_word; ++i)
      value = value << 1
              | static_cast<std::uint32_t>(i + lost < bits && is_set(i + lost));
    auto word = words;
    word.skip(std::size_t{first / bits_a_word} * 4);
    put_word(word, value);
  }
}

void lower_acknack(const submessage_view& x, std::int64_t by) {
  auto at = x.body;
  at.skip(endpoints_bytes);
  const auto place = at;
  const auto base = at.sequence_number();
  const auto bits = at.u32();
  if (!at.good() || base == 0) // Asks for all that there is.
    return;
  const auto lowered = std::max<std::int64_t>(base - by, 1);
  put_number(place, lowered);
  if (base <= by)
    move_bits(at, bits,
              static_cast<std::uint32_t>(
                  std::min<std::int64_t>(by + 1 - base, bits)));
}

} // namespace

number_shift::number_shift(const guid_prefix& self,
                           std::shared_ptr<number_reserve> reserve)
    : self_(self), reserve_(std::move(reserve)),
      begin_(reserve_->begin_life()) {}

void number_shift::let_out(std::uint8_t* message, std::size_t size) const {
  for_each_submessage(message, size, [this](const submessage_view& x) {
    std::int64_t used = begin_;
    if (x.kind == submessage_kind::data)
      used = raise_data(x, self_, begin_);
    else if (x.kind == submessage_kind::heartbeat)
      used = raise_heartbeat(x, begin_, reserve_->next_count());
    else if (x.kind == submessage_kind::gap)
      used = raise_gap(x, begin_);
    else if (x.kind == submessage_kind::acknack && x.body.size() >= 4) {
      auto at = x.body;
      at.skip(at.size() - 4);
      put_word(at, reserve_->next_count());
    }
    reserve_->use_sequence(used);
    return true;
  });
}

void number_shift::take_in(std::uint8_t* message, std::size_t size) const {
  for_each_submessage(message, size, [this](const submessage_view& x) {
    if (x.kind == submessage_kind::acknack)
      lower_acknack(x, begin_);
    return true;
  });
}

} // namespace roscell
