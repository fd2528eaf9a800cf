#include "actors/edge/history/event_files.hpp"
#include "actors/edge/history/limits.hpp"

#include "actors/edge/history/event_lines.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <utility>

/// How events are read back.
namespace roscell {

/// Calls `on_line` with number and text of each line, until it says false. What
/// is longer than any of ours is passed over.
void event_files::visit(uint64_t first, const visitor& on_line) const {
  std::ifstream in{path_of(first), std::ios::binary};
  std::string buffer(limits::history::line_bytes + 1, '\0');
  while (in.good()) {
    in.getline(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    if (in.fail() && !in.eof() && !in.bad()) {
      in.clear();
      in.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
      continue;
    }
    // The newline is counted, but is not there.
    const auto size = static_cast<size_t>(in.gcount()) - (in.good() ? 1 : 0);
    const std::string_view line{buffer.data(), size};
    if (const auto number = number_of(line); number && !on_line(*number, line))
      return;
  }
}

uint64_t event_files::highest() const {
  uint64_t result = 0;
  if (!files_.empty())
    visit(files_.rbegin()->first, [&](uint64_t number, std::string_view) {
      result = std::max(result, number);
      return true;
    });
  return result;
}

/// The number after which the `count` newest ones of those after `since` begin.
uint64_t event_files::begin_of_newest(uint64_t since, uint64_t count) const {
  count = std::min<uint64_t>(count, limits::history::newest);
  std::vector<uint64_t> numbers; // Of the file, in its order.
  for (auto i = files_.rbegin(); i != files_.rend() && count > 0; ++i) {
    numbers.clear();
    visit(i->first, [&](uint64_t number, std::string_view) {
      numbers.push_back(number);
      return true;
    });
    if (numbers.size() >= count)
      return std::max(since, numbers[numbers.size() - count] - 1);
    count -= numbers.size();
  }
  return since;
}

/// The number after which those of `unix_ms` or later begin. What is in a file
/// is not younger than the file, so that most need not be read.
uint64_t event_files::begin_of_time(uint64_t since, int64_t unix_ms) const {
  auto i = std::find_if(files_.begin(), files_.end(), [&](const auto& x) {
    return x.second.written_unix_ms >= unix_ms;
  });
  if (i == files_.end())
    return std::max(since, highest());
  since = std::max(since, i->first - 1);
  bool found = false;
  for (; i != files_.end() && !found; ++i)
    visit(i->first, [&](uint64_t number, std::string_view line) {
      const auto x = event_of(line);
      found = x && x->time_unix_ms >= unix_ms;
      if (!found)
        since = std::max(since, number);
      return !found;
    });
  return since;
}

std::vector<event> event_files::read(const past_events_query& query) const {
  auto since = query.since;
  if (query.since_unix_ms > 0)
    since = begin_of_time(since, query.since_unix_ms);
  if (query.newest > 0)
    since = begin_of_newest(since, query.newest);
  std::vector<event> result;
  size_t bytes = 0;
  const auto is_full = [&] {
    return result.size() >= limits::history::part
           || bytes >= limits::history::part_bytes;
  };
  auto i = files_.upper_bound(since + 1);
  if (i != files_.begin())
    --i;
  for (; i != files_.end() && !is_full(); ++i)
    visit(i->first, [&](uint64_t number, std::string_view line) {
      if (number <= since)
        return true;
      if (auto x = event_of(line)) {
        since = number;
        bytes += line.size();
        result.push_back(std::move(*x));
      }
      return !is_full();
    });
  return result;
}

} // namespace roscell
