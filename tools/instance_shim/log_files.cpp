#include "tools/instance_shim/log_files.hpp"

#include <dirent.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>

namespace roscell::shim {

namespace {

/// `log.` or `times.` and a 64-bit number.
struct file_name {
  explicit file_name(std::uint64_t offset, const char* what = "log") {
    std::snprintf(text, sizeof(text), "%s.%llu", what,
                  static_cast<unsigned long long>(offset));
  }

  char text[32];
};

/// Returns whether `name` is that of a log file, and its offset.
bool parse(const char* name, std::uint64_t& offset) {
  if (std::strncmp(name, "log.", 4) != 0 || name[4] < '0' || name[4] > '9')
    return false;
  char* end = nullptr;
  offset = std::strtoull(name + 4, &end, 10);
  return *end == '\0';
}

std::uint64_t size_of(int directory, const char* name) {
  struct stat info {};
  if (::fstatat(directory, name, &info, 0) != 0)
    return 0;
  return static_cast<std::uint64_t>(info.st_size);
}

/// What `times.<offset>` holds.
struct time_note {
  std::uint64_t offset;
  std::int64_t unix_ms;
};

std::int64_t now_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

void close_file(int& fd) {
  if (fd >= 0)
    ::close(fd);
  fd = -1;
}

} // namespace

log_files::log_files(int directory, std::uint64_t max_bytes)
    : directory_(directory), max_file_bytes_(max_bytes / 2) {
  find_newest();
  ensure_open();
  if (start_ + size_ > 0)
    note_start();
}

log_files::~log_files() {
  close_file(file_);
  close_file(times_);
}

void log_files::write(const char* data, std::size_t size) {
  note_loss();
  auto done = append(data, size);
  lost_bytes_ += size - done;
}

void log_files::drop_older() {
  if (has_older_)
    remove(older_start_);
  has_older_ = false;
}

void log_files::remove(std::uint64_t offset) {
  ::unlinkat(directory_, file_name{offset}.text, 0);
  ::unlinkat(directory_, file_name{offset, "times"}.text, 0);
}

/// Keeps the two newest files of earlier runs.
void log_files::find_newest() {
  auto copy = ::openat(directory_, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  auto* folder = copy < 0 ? nullptr : ::fdopendir(copy);
  if (folder == nullptr)
    return;
  std::uint64_t newest = 0;
  auto found = 0;
  while (const auto* entry = ::readdir(folder)) {
    std::uint64_t offset = 0;
    if (!parse(entry->d_name, offset))
      continue;
    if (found++ == 0) {
      newest = offset;
      continue;
    }
    const auto older = std::min(newest, offset);
    newest = std::max(newest, offset);
    if (has_older_)
      remove(std::min(older_start_, older));
    older_start_ = has_older_ ? std::max(older_start_, older) : older;
    has_older_ = true;
  }
  ::closedir(folder);
  if (found > 0)
    go_on_in(newest);
}

void log_files::go_on_in(std::uint64_t newest) {
  start_ = newest;
  size_ = size_of(directory_, file_name{newest}.text);
  find_last_note();
  if (is_full())
    rotate();
}

/// What was noted of bytes that were lost with the power, or half of a note,
/// would make the notes after it unreadable.
void log_files::find_last_note() {
  const file_name name{start_, "times"};
  times_size_ = size_of(directory_, name.text);
  times_size_ -= times_size_ % sizeof(time_note);
  const auto file = ::openat(directory_, name.text, O_RDONLY | O_CLOEXEC);
  time_note last{};
  while (times_size_ > 0
         && (::pread(file, &last, sizeof(last),
                     static_cast<off_t>(times_size_ - sizeof(last)))
                 != static_cast<ssize_t>(sizeof(last))
             || last.offset >= start_ + size_))
    times_size_ -= sizeof(last);
  if (file >= 0)
    ::close(file);
}

/// One log has all runs of its instance, and a reader wants to tell them apart.
void log_files::note_start() {
  constexpr char line[] = "\n[shim: started again]\n";
  char last = '\n';
  const auto whose = size_ > 0 ? start_ : older_start_;
  const auto file =
      ::openat(directory_, file_name{whose}.text, O_RDONLY | O_CLOEXEC);
  const auto end =
      static_cast<off_t>(size_ > 0 ? size_ : start_ - older_start_);
  if (file >= 0 && ::pread(file, &last, 1, end - 1) != 1)
    last = '\n';
  if (file >= 0)
    ::close(file);
  const auto skipped = last == '\n' ? 1 : 0;
  append(line + skipped, sizeof(line) - 1 - skipped);
}

bool log_files::ensure_open() {
  if (file_ < 0)
    file_ = ::openat(directory_, file_name{start_}.text,
                     O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  return file_ >= 0;
}

/// What stands behind the last whole note is cut off.
bool log_files::ensure_times_open() {
  if (times_ >= 0)
    return true;
  times_ = ::openat(directory_, file_name{start_, "times"}.text,
                    O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  if (times_ >= 0 && ::ftruncate(times_, static_cast<off_t>(times_size_)) != 0)
    close_file(times_);
  return times_ >= 0;
}

/// Both files of a pair begin and end together.
bool log_files::is_full() const {
  return size_ >= max_file_bytes_
         || times_size_ + sizeof(time_note) > max_file_bytes_ / 4;
}

/// Notes the time of what is written next, unless that of what was written
/// before is the same. Half a note would make those after it unreadable.
void log_files::note_time() {
  const auto now = now_ms();
  if (now == noted_ms_)
    return;
  const time_note note{start_ + size_, now};
  if (!ensure_times_open())
    return;
  const auto n = ::write(times_, &note, sizeof(note));
  if (n == static_cast<ssize_t>(sizeof(note))) {
    times_size_ += sizeof(note);
    noted_ms_ = now;
  } else if (n > 0
             && ::ftruncate(times_, static_cast<off_t>(times_size_)) != 0) {
    close_file(times_);
    times_size_ = 0;
  }
}

void log_files::rotate() {
  close_file(file_);
  close_file(times_);
  // The oldest goes first, so that the bound holds at every moment.
  drop_older();
  older_start_ = start_;
  has_older_ = true;
  start_ += size_;
  size_ = 0;
  times_size_ = 0;
  noted_ms_ = 0;
}

/// Returns how many bytes were written.
std::size_t log_files::append(const char* data, std::size_t size) {
  std::size_t done = 0;
  while (done < size) {
    if (is_full())
      rotate();
    if (!ensure_open())
      return done;
    note_time();
    auto most = std::min<std::uint64_t>(size - done, max_file_bytes_ - size_);
    auto n = ::write(file_, data + done, most);
    if (n < 0 && errno == EINTR)
      continue;
    if (n <= 0)
      return done;
    done += static_cast<std::size_t>(n);
    size_ += static_cast<std::uint64_t>(n);
  }
  return done;
}

void log_files::note_loss() {
  if (lost_bytes_ == 0)
    return;
  char line[96];
  auto size = std::snprintf(line, sizeof(line),
                            "\n[shim: %llu bytes of log were lost, the disk "
                            "was full]\n",
                            static_cast<unsigned long long>(lost_bytes_));
  if (append(line, static_cast<std::size_t>(size)) > 0)
    lost_bytes_ = 0;
}

} // namespace roscell::shim
