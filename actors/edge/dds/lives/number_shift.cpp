#include "actors/edge/dds/lives/number_shift.hpp"

#include "actors/edge/dds/rtps/wire_numbers.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

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
