#include "actors/edge/history/event_files.hpp"

#include "actors/edge/history/event_lines.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/house/limits.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <string>
#include <utility>

/// How events are read back.
namespace roscell {

namespace {

/// The whole of a file, at most as much as one of ours holds.
std::string content_of(const std::filesystem::path& path) {
  constexpr size_t most =
      limits::history::file_bytes + limits::history::batch * 4 * limits::kib;
  const unique_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  struct stat info {};
  if (!fd || ::fstat(fd.get(), &info) != 0 || !S_ISREG(info.st_mode))
    return {};
  std::string result(std::min(static_cast<size_t>(info.st_size), most), '\0');
  size_t size = 0;
  while (size < result.size()) {
    const auto n = ::read(fd.get(), &result[size], result.size() - size);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      break;
    size += static_cast<size_t>(n);
  }
  result.resize(size);
  return result;
}

} // namespace

/// Calls `on_line` with number and text of each line, until it says false.
void event_files::visit(uint64_t first, const visitor& on_line) const {
  const auto text = content_of(path_of(first));
  for (std::string_view rest{text}; !rest.empty();) {
    const auto end = std::min(rest.find('\n'), rest.size());
    const auto line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
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

/// The number after which those of `unix_ms` or later begin.
uint64_t event_files::begin_of_time(uint64_t since, int64_t unix_ms) const {
  uint64_t result = since;
  bool found = false;
  for (auto i = files_.begin(); i != files_.end() && !found; ++i) {
    // What is in a file is not younger than the file.
    const bool may_hold = i->second.written_unix_ms >= unix_ms;
    visit(i->first, [&](uint64_t number, std::string_view line) {
      const auto x = may_hold ? event_of(line) : std::nullopt;
      found = x && x->time_unix_ms >= unix_ms;
      if (!found)
        result = std::max(result, number);
      return !found;
    });
  }
  return result;
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
