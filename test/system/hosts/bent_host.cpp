#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/timex.h>
#include <unistd.h>

#include <cstdlib>
#include <ctime>

// A library to be preloaded: its process finds its host in a state that tests
// cannot bring about, since network namespaces share the kernel's clock and the
// disk. What the environment does not say is as it is.
//
// CLOCK_OFFSET_S  The wall clock is so far ahead; other clocks are right.
// CLOCK_ERROR_US  The wall clock is synchronised and may be wrong by so much;
//                 negative: nothing synchronises it.
// FSYNC_MS        So long the disk takes to keep what was written.
// SOCKET_BYTES    So much a socket's buffers hold.

namespace {

/// Whether the environment has a number of that name.
bool has_setting(const char* name, long& value) {
  const char* text = std::getenv(name);
  if (text == nullptr)
    return false;
  value = std::strtol(text, nullptr, 10);
  return true;
}

} // namespace

extern "C" {

__attribute__((visibility("default"))) int
clock_gettime(clockid_t clock, timespec* now) noexcept {
  const auto failed = static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  long offset_s = 0;
  if (failed == 0 && clock == CLOCK_REALTIME
      && has_setting("CLOCK_OFFSET_S", offset_s))
    now->tv_sec += offset_s;
  return failed;
}

__attribute__((visibility("default"))) int adjtimex(timex* clock) noexcept {
  const auto state = static_cast<int>(syscall(SYS_adjtimex, clock));
  long error_us = 0;
  if (!has_setting("CLOCK_ERROR_US", error_us))
    return state;
  clock->status = error_us < 0 ? STA_UNSYNC : 0;
  clock->maxerror = error_us;
  return error_us < 0 ? TIME_ERROR : TIME_OK;
}

__attribute__((visibility("default"))) int fsync(int fd) {
  long delay_ms = 0;
  if (has_setting("FSYNC_MS", delay_ms)) {
    const timespec delay{delay_ms / 1000, delay_ms % 1000 * 1'000'000};
    nanosleep(&delay, nullptr);
  }
  return static_cast<int>(syscall(SYS_fsync, fd));
}

__attribute__((visibility("default"))) int
getsockopt(int fd, int level, int name, void* value, socklen_t* size) noexcept {
  long bytes = 0;
  if (level == SOL_SOCKET && (name == SO_RCVBUF || name == SO_SNDBUF)
      && has_setting("SOCKET_BYTES", bytes)) {
    // The kernel tells twice of what it gives.
    *static_cast<int*>(value) = static_cast<int>(2 * bytes);
    return 0;
  }
  return static_cast<int>(
      syscall(SYS_getsockopt, fd, level, name, value, size));
}

} // extern "C"
