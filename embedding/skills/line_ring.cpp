#include "embedding/skills/line_ring.hpp"

#include "actors/edge/limits.hpp"
#include "actors/edge/process/instance_log.hpp"
#include "schemas/utf8.hpp"

#include <algorithm>
#include <utility>

namespace roscell::embedding {

namespace {

constexpr std::size_t most_line_bytes = 4096;

/// It must neither forge nor split lines of a log.
std::string one_line(std::string text) {
  text.resize(std::min(text.size(), most_line_bytes));
  std::replace_if(
      text.begin(), text.end(),
      [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
  return valid_utf8(text) + '\n';
}

} // namespace

line_ring::line_ring(std::size_t most_bytes, std::function<void()> on_line)
    : most_bytes_(most_bytes), on_line_(std::move(on_line)) {}

void line_ring::add(std::string text, std::int64_t now_unix_ms) {
  {
    std::lock_guard<std::mutex> lock{mutex_};
    lines_.push_back({one_line(std::move(text)), now_unix_ms});
    bytes_ += lines_.back().text.size();
    while (bytes_ > most_bytes_ && lines_.size() > 1) {
      const auto gone = lines_.front().text.size();
      bytes_ -= gone;
      dropped_bytes_ += static_cast<std::int64_t>(gone);
      lines_.pop_front();
    }
  }
  on_line_();
}

line_ring::excerpt line_ring::read_from(std::int64_t offset) const {
  std::lock_guard<std::mutex> lock{mutex_};
  std::size_t first = 0;
  for (auto at = dropped_bytes_; first < lines_.size() && at < offset; ++first)
    at += static_cast<std::int64_t>(lines_[first].text.size());
  return read(first);
}

line_ring::excerpt line_ring::read_tail(std::size_t lines) const {
  std::lock_guard<std::mutex> lock{mutex_};
  return read(lines_.size() - std::min(lines, lines_.size()));
}

line_ring::excerpt line_ring::read(std::size_t first_line) const {
  excerpt result;
  result.next_offset = dropped_bytes_;
  for (std::size_t i = 0; i < first_line; ++i)
    result.next_offset += static_cast<std::int64_t>(lines_[i].text.size());
  auto i = first_line;
  for (; i < lines_.size() && result.text.size() < limits::log::part_bytes
         && i - first_line < static_cast<std::size_t>(most_timed_lines);
       ++i) {
    result.text += lines_[i].text;
    result.times_unix_ms.push_back(lines_[i].time_unix_ms);
  }
  result.next_offset += static_cast<std::int64_t>(result.text.size());
  result.is_whole = i == lines_.size();
  return result;
}

} // namespace roscell::embedding
