#include "actors/edge/history/event_files.hpp"

#include "actors/edge/disk/small_file.hpp"
#include "actors/edge/history/event_lines.hpp"
#include "actors/edge/history/limits.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view events_prefix = "events.";

/// A file takes whole blocks.
constexpr uint64_t block_bytes = 4096;

/// More than the bound can hold; what else lies there is not looked at.
constexpr size_t most_files = 65'536;

std::optional<uint64_t> first_number_of(const std::string& name) {
  if (name.compare(0, events_prefix.size(), events_prefix) != 0)
    return std::nullopt;
  uint64_t result = 0;
  const auto* end = name.data() + name.size();
  const auto [rest, error] =
      std::from_chars(name.data() + events_prefix.size(), end, result);
  if (error != std::errc{} || rest != end || result == 0)
    return std::nullopt;
  return result;
}

int64_t written_ms(const struct stat& info) {
  return static_cast<int64_t>(info.st_mtim.tv_sec) * 1000
         + info.st_mtim.tv_nsec / 1'000'000;
}

edge_error cannot_write(const fs::path& file, int problem) {
  return {error_code::internal,
          "cannot write '" + file.string() + "': " + std::strerror(problem),
          "free some disk space, or give this user write access"};
}

/// Whether what stands there ends with a whole line.
bool ends_whole(int fd, off_t size) {
  char last = '\n';
  return size == 0 || (::pread(fd, &last, 1, size - 1) == 1 && last == '\n');
}

/// A file that was just made is there after a loss of power only with its name.
bool keep_name_in(const fs::path& folder) {
  const unique_fd fd{
      ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)};
  return fd && ::fsync(fd.get()) == 0;
}

} // namespace

event_files::event_files(fs::path folder) : folder_(std::move(folder)) {
  std::error_code error;
  for (fs::directory_iterator i{folder_, error}, end;
       !error && i != end && files_.size() < most_files; i.increment(error)) {
    const auto first = first_number_of(i->path().filename().string());
    struct stat info {};
    if (first && ::lstat(i->path().c_str(), &info) == 0
        && S_ISREG(info.st_mode))
      files_[*first] = {static_cast<uint64_t>(info.st_size), written_ms(info)};
  }
}

fs::path event_files::path_of(uint64_t first) const {
  return folder_ / (std::string{events_prefix} + std::to_string(first));
}

/// The last file while it is small and young, else a new one. A clock that was
/// set back does not make that one look older than what is in it.
uint64_t event_files::file_for(uint64_t first, int64_t now_unix_ms) const {
  using std::chrono::milliseconds;
  if (files_.empty())
    return first;
  const auto& [begin, last] = *files_.rbegin();
  const auto since = begun_unix_ms_ > 0 ? begun_unix_ms_ : last.written_unix_ms;
  const bool is_young =
      now_unix_ms >= last.written_unix_ms
      && milliseconds{now_unix_ms - since} < limits::history::file_age;
  return is_young && last.bytes < limits::history::file_bytes ? begin : first;
}

std::optional<edge_error> event_files::append(const std::vector<event>& events,
                                              int64_t now_unix_ms) {
  if (events.empty())
    return std::nullopt;
  const auto first = file_for(events.front().sequence, now_unix_ms);
  const bool is_new = files_.count(first) == 0;
  const auto path = path_of(first);
  const unique_fd fd{
      ::open(path.c_str(), O_RDWR | O_CREAT | O_APPEND | O_CLOEXEC | O_NOFOLLOW,
             0600)};
  struct stat info {};
  if (!fd || ::fstat(fd.get(), &info) != 0)
    return cannot_write(path, errno);
  // A loss of power may have torn the last line of an earlier run.
  std::string text{ends_whole(fd.get(), info.st_size) ? "" : "\n"};
  for (const auto& x : events)
    text += line_of(x);
  if (!write_whole(fd.get(), text) || ::fdatasync(fd.get()) != 0
      || (is_new && !keep_name_in(folder_))) {
    const int problem = errno;
    if (is_new)
      ::unlink(path.c_str());
    else if (::ftruncate(fd.get(), info.st_size) != 0)
      files_[first].bytes = limits::history::file_bytes;
    return cannot_write(path, problem);
  }
  if (is_new)
    begun_unix_ms_ = now_unix_ms;
  files_[first] = {static_cast<uint64_t>(info.st_size) + text.size(),
                   now_unix_ms};
  return std::nullopt;
}

uint64_t event_files::bytes() const {
  uint64_t result = 0;
  for (const auto& [first, x] : files_)
    result += (x.bytes / block_bytes + 1) * block_bytes;
  return result;
}

std::optional<int64_t> event_files::oldest_unix_ms() const {
  if (files_.empty())
    return std::nullopt;
  return files_.begin()->second.written_unix_ms;
}

bool event_files::drop_oldest() {
  if (files_.empty())
    return false;
  if (::unlink(path_of(files_.begin()->first).c_str()) != 0 && errno != ENOENT)
    return false;
  if (files_.size() == 1)
    begun_unix_ms_ = 0;
  files_.erase(files_.begin());
  return true;
}

// How events are read back.

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
