#include "tools/instance_shim/records.hpp"

#include "tools/instance_shim/log_files.hpp"

#include <fcntl.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace roscell::shim {

namespace {

/// More than the longest record.
constexpr int record_bytes = 256;

/// Field 22 of /proc/self/stat, or 0. Field 2 is the name in parentheses,
/// which may itself hold blanks and parentheses.
unsigned long long own_start_time() {
  char text[1024];
  auto fd = ::open("/proc/self/stat", O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return 0;
  auto size = ::read(fd, text, sizeof(text) - 1);
  ::close(fd);
  if (size <= 0)
    return 0;
  text[size] = '\0';
  const auto* at = std::strrchr(text, ')');
  for (auto field = 2; at != nullptr && field < 22; ++field)
    at = std::strchr(at + 1, ' ');
  return at != nullptr ? std::strtoull(at + 1, nullptr, 10) : 0;
}

long long unix_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_REALTIME, &now);
  return now.tv_sec * 1000LL + now.tv_nsec / 1'000'000;
}

int format_exit(const child_end& end, char* text) {
  char code[16] = "null";
  char signal[16] = "null";
  if (WIFSIGNALED(end.wait_status))
    std::snprintf(signal, sizeof(signal), "%d", WTERMSIG(end.wait_status));
  else
    std::snprintf(code, sizeof(code), "%d", WEXITSTATUS(end.wait_status));
  char memory[96] = "";
  if (end.memory.most >= 0)
    std::snprintf(memory, sizeof(memory),
                  ",\"memory_kills\":%lld,\"most_memory_bytes\":%lld",
                  end.memory.kills, end.memory.most);
  else if (end.memory.kills > 0)
    std::snprintf(memory, sizeof(memory), ",\"memory_kills\":%lld",
                  end.memory.kills);
  return std::snprintf(
      text, record_bytes,
      "{\"code\":%s,\"signal\":%s,\"at_unix_ms\":%lld%s%s%s}\n", code, signal,
      unix_ms(), end.fenced ? ",\"fenced\":true" : "",
      end.terminated ? ",\"terminated\":true" : "", memory);
}

} // namespace

bool write_pid(int directory, pid_t child) {
  char text[96];
  std::snprintf(text, sizeof(text), "%d %llu %d", ::getpid(), own_start_time(),
                child);
  ::unlinkat(directory, "pid.tmp", 0);
  return ::symlinkat(text, directory, "pid.tmp") == 0
         && ::renameat(directory, "pid.tmp", directory, "pid") == 0;
}

exit_record::exit_record(int directory) : directory_(directory) {
  ::unlinkat(directory_, "exit", 0);
  file_ = ::openat(directory_, "exit.tmp",
                   O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
  if (file_ >= 0)
    ::posix_fallocate(file_, 0, record_bytes);
}

exit_record::exit_record(const char* file)
    : file_(::open(file, O_WRONLY | O_CLOEXEC | O_NOFOLLOW)) {
  // nop
}

exit_record::~exit_record() {
  if (file_ >= 0)
    ::close(file_);
}

bool exit_record::write(const child_end& end, log_files* log) {
  char text[record_bytes];
  auto size = format_exit(end, text);
  if (store(text, size))
    return true;
  if (log == nullptr)
    return false;
  // A file system that cannot reserve room may be full: the end of the child
  // is worth more than its old output.
  log->drop_older();
  return store(text, size);
}

bool exit_record::store(const char* text, int size) {
  const bool written =
      ::pwrite(file_, text, static_cast<std::size_t>(size), 0) == size
      && ::ftruncate(file_, size) == 0 && ::fsync(file_) == 0;
  return written
         && (directory_ < 0
             || (::renameat(directory_, "exit.tmp", directory_, "exit") == 0
                 && ::fsync(directory_) == 0));
}

} // namespace roscell::shim
