#include "actors/edge/dds/lives/number_reserve.hpp"

#include "actors/edge/disk/lasting_file.hpp"

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

} // namespace roscell
