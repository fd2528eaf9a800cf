#include "actors/edge/process/instance_log.hpp"

#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/limits.hpp"
#include "schemas/utf8.hpp"

#include <fcntl.h>
#include <sys/stat.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstddef>
#include <optional>
#include <string_view>
#include <system_error>
#include <utility>

namespace roscell {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view prefix = "log.";

/// More files than a shim ever keeps; what else lies there is not ours.
constexpr size_t max_files = 16;

std::optional<int64_t> start_of(const std::string& name) {
  if (name.compare(0, prefix.size(), prefix) != 0)
    return std::nullopt;
  int64_t result = 0;
  const auto* end = name.data() + name.size();
  const auto [rest, error] =
      std::from_chars(name.data() + prefix.size(), end, result);
  if (error != std::errc{} || rest != end || result < 0)
    return std::nullopt;
  return result;
}

} // namespace

instance_log::instance_log(fs::path folder) : folder_(std::move(folder)) {
  // nop
}

bool instance_log::exists() const {
  std::error_code error;
  return fs::is_directory(folder_, error);
}

bool instance_log::has_ended() const {
  std::error_code error;
  return fs::exists(folder_ / "exit", error);
}

std::vector<instance_log::file> instance_log::files() const {
  std::vector<file> result;
  std::error_code error;
  for (fs::directory_iterator i{folder_, error}, end;
       !error && i != end && result.size() < max_files; i.increment(error)) {
    const auto start = start_of(i->path().filename().string());
    struct stat info {};
    if (start && ::lstat(i->path().c_str(), &info) == 0
        && S_ISREG(info.st_mode))
      result.push_back({*start, static_cast<int64_t>(info.st_size)});
  }
  std::sort(result.begin(), result.end(),
            [](const file& x, const file& y) { return x.start < y.start; });
  return result;
}

/// Empty if the file is gone.
std::string instance_log::bytes(const file& x, int64_t from,
                                int64_t most) const {
  const auto path = folder_ / (std::string{prefix} + std::to_string(x.start));
  const unique_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  if (!fd)
    return {};
  std::string result(static_cast<size_t>(most), '\0');
  size_t size = 0;
  while (size < result.size()) {
    const auto n = ::pread(fd.get(), &result[size], result.size() - size,
                           from - x.start + static_cast<int64_t>(size));
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      break;
    size += static_cast<size_t>(n);
  }
  result.resize(size);
  return result;
}

instance_log::chunk instance_log::read(int64_t from) const {
  chunk result;
  const auto all = files();
  if (all.empty())
    return result;
  result.end = all.back().start + all.back().size;
  result.from = std::clamp(from, all.front().start, result.end);
  for (const auto& x : all) {
    const auto at = result.from + static_cast<int64_t>(result.bytes.size());
    const auto left = result.from + limits::log::part_bytes - at;
    const bool gap = x.start > at;
    // The bytes of a gap are lost; what is behind it makes the next part.
    if (left <= 0 || (gap && !result.bytes.empty()))
      break;
    if (x.start + x.size <= at)
      continue;
    if (gap)
      result.from = x.start;
    const auto begin = std::max(at, x.start);
    // A file that was dropped meanwhile gives nothing, and the next is a gap.
    result.bytes += bytes(x, begin, std::min(left, x.start + x.size - begin));
  }
  return result;
}

namespace {

/// The note at `index` of a file of times; none behind its end.
std::optional<time_note> note_at(int fd, int64_t index) {
  time_note result;
  const auto at = index * static_cast<int64_t>(sizeof(result));
  const auto n = ::pread(fd, &result, sizeof(result), at);
  if (n != static_cast<ssize_t>(sizeof(result)))
    return std::nullopt;
  return result;
}

/// How many notes of the file are at `offset` or before it.
int64_t notes_before(int fd, int64_t count, int64_t offset) {
  int64_t low = 0;
  while (low < count) {
    const auto middle = (low + count) / 2;
    const auto note = note_at(fd, middle);
    if (note && note->offset <= offset)
      low = middle + 1;
    else
      count = middle;
  }
  return low;
}

/// Adds what the file tells of the bytes from `from` to `to`.
void add_notes(const fs::path& path, int64_t from, int64_t to,
               std::vector<time_note>& result) {
  const unique_fd fd{::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW)};
  struct stat info {};
  if (!fd || ::fstat(fd.get(), &info) != 0 || !S_ISREG(info.st_mode))
    return;
  const auto count = info.st_size / static_cast<int64_t>(sizeof(time_note));
  auto i = std::max<int64_t>(0, notes_before(fd.get(), count, from) - 1);
  // A note tells of a byte at least, so this ends even with a file gone wrong.
  for (auto left = to - from + 1; left > 0; --left) {
    const auto note = note_at(fd.get(), i++);
    if (!note || note->offset >= to)
      return;
    result.push_back(*note);
  }
}

} // namespace

std::vector<time_note> instance_log::notes(int64_t from, int64_t to) const {
  std::vector<time_note> result;
  for (const auto& x : files())
    if (x.start < to && x.start + x.size > from)
      add_notes(folder_ / ("times." + std::to_string(x.start)), from, to,
                result);
  return result;
}

log_part instance_log::read_from(int64_t offset, bool times) const {
  // Asked first: what the program wrote before it ended is then seen below.
  const bool ended = has_ended();
  auto [from, text, end] = read(offset);
  const auto read_to = from + static_cast<int64_t>(text.size());
  log_part result;
  result.ended = ended && read_to >= end;
  if (times) {
    const auto most = bytes_of_lines(text, most_timed_lines);
    result.ended = result.ended && most == text.size();
    text.resize(most);
  }
  // The rest of a character may still be on its way.
  if (!result.ended)
    text.resize(text.size() - unfinished_utf8(text));
  result.next_offset = from + static_cast<int64_t>(text.size());
  if (times)
    result.times_unix_ms =
        line_times(text, from, notes(from, result.next_offset));
  result.text = valid_utf8(text);
  if (result.text != text)
    result.bytes = to_base64(text);
  return result;
}

log_part instance_log::read_tail(int64_t lines, bool times) const {
  const auto all = files();
  const auto end = all.empty() ? 0 : all.back().start + all.back().size;
  const auto last = read(std::max<int64_t>(0, end - limits::log::part_bytes));
  const auto most = times ? most_timed_lines : limits::log::part_bytes;
  const auto wanted = std::clamp<int64_t>(lines, 0, most);
  return read_from(
      last.from + static_cast<int64_t>(begin_of_last_lines(last.bytes, wanted)),
      times);
}

std::vector<int64_t> line_times(std::string_view bytes, int64_t from,
                                const std::vector<time_note>& notes) {
  std::vector<int64_t> result;
  size_t next = 0;
  int64_t known = 0;
  for (size_t at = 0; at < bytes.size();) {
    const auto offset = from + static_cast<int64_t>(at);
    for (; next < notes.size() && notes[next].offset <= offset; ++next)
      known = std::max<int64_t>(0, notes[next].unix_ms);
    result.push_back(known);
    const auto end = bytes.find('\n', at);
    at = end == std::string_view::npos ? bytes.size() : end + 1;
  }
  return result;
}

size_t bytes_of_lines(std::string_view text, int64_t lines) {
  size_t result = 0;
  for (; lines > 0 && result < text.size(); --lines) {
    const auto newline = text.find('\n', result);
    if (newline == std::string_view::npos)
      return text.size();
    result = newline + 1;
  }
  return result;
}

size_t begin_of_last_lines(std::string_view text, int64_t lines) {
  auto at = text.size();
  if (at > 0 && text[at - 1] == '\n')
    --at;
  for (; lines > 0; --lines) {
    const auto newline = at == 0 ? text.npos : text.rfind('\n', at - 1);
    if (newline == text.npos)
      return 0;
    at = newline;
  }
  return std::min(at + 1, text.size());
}

} // namespace roscell
