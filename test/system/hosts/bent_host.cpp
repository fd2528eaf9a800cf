#include <fcntl.h>
#include <pthread.h>
#include <semaphore.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/time.h>
#include <sys/timex.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <ctime>

// A library to be preloaded: its process finds its host in a state that tests
// cannot bring about, since network namespaces share the kernel's clock and the
// disk. What the environment does not say is as it is.
//
// CLOCK_OFFSET_S  The wall clock is so far ahead; other clocks are right.
// CLOCK_FILE      The wall clock is so far ahead as this file says just then,
// in
//                 seconds and 24 bytes: a test sets the clock by it. Who waits
//                 for a time of day hears of it within a tenth of a second.
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

constexpr size_t file_bytes = 24;
constexpr std::int64_t second_ns = 1'000'000'000;

/// The file that sets the clock; null if there is none.
const char* map_clock_file() {
  const char* path = std::getenv("CLOCK_FILE");
  const int fd = path == nullptr ? -1 : open(path, O_RDONLY | O_CLOEXEC);
  if (fd < 0)
    return nullptr;
  void* seen = mmap(nullptr, file_bytes, PROT_READ, MAP_SHARED, fd, 0);
  close(fd);
  return seen == MAP_FAILED ? nullptr : static_cast<const char*>(seen);
}

long offset_of_file() {
  static std::atomic<const char*> known{nullptr};
  const char* seen = known.load();
  if (seen == nullptr) {
    seen = map_clock_file();
    if (seen == nullptr)
      return 0;
    // Whoever comes second leaves a page behind, once.
    known = seen;
  }
  return std::strtol(seen, nullptr, 10);
}

timespec kernel_time(clockid_t clock) {
  timespec now{};
  syscall(SYS_clock_gettime, clock, &now);
  return now;
}

timespec wall_time() {
  auto now = kernel_time(CLOCK_REALTIME);
  long offset_s = 0;
  if (!has_setting("CLOCK_OFFSET_S", offset_s))
    offset_s = offset_of_file();
  now.tv_sec += offset_s;
  return now;
}

std::int64_t ns_of(const timespec& x) {
  return x.tv_sec * second_ns + x.tv_nsec;
}

/// A step on the way to a time of day: when it ends by the clock that nobody
/// sets, and whether it is the last one.
struct wait_step {
  timespec until;
  bool last;
};

wait_step step_to(const timespec& time_of_day) {
  constexpr std::int64_t longest = second_ns / 10;
  const auto left = ns_of(time_of_day) - ns_of(wall_time());
  const auto end = ns_of(kernel_time(CLOCK_MONOTONIC))
                   + std::clamp<std::int64_t>(left, 0, longest);
  return {{end / second_ns, end % second_ns}, left <= longest};
}

/// Whether a condition was made to go by the clock that nobody sets
/// (pthread_condattr_setclock), by the bit in which glibc keeps that.
bool is_monotonic(const pthread_cond_t* x) {
  return (x->__data.__wrefs & 2) != 0;
}

} // namespace

extern "C" {

__attribute__((visibility("default"))) int
gettimeofday(timeval* now, void* /*zone*/) noexcept {
  const auto seen = wall_time();
  *now = {seen.tv_sec, seen.tv_nsec / 1000};
  return 0;
}

__attribute__((visibility("default"))) time_t time(time_t* now) noexcept {
  const auto seen = wall_time().tv_sec;
  if (now != nullptr)
    *now = seen;
  return seen;
}

/// A step that is not the last one ends as if somebody had woken it for
/// nothing, so that no real wake-up gets lost.
__attribute__((visibility("default"))) int
pthread_cond_timedwait(pthread_cond_t* what, pthread_mutex_t* mutex,
                       const timespec* until) {
  if (is_monotonic(what))
    return pthread_cond_clockwait(what, mutex, CLOCK_MONOTONIC, until);
  const auto step = step_to(*until);
  const int failed =
      pthread_cond_clockwait(what, mutex, CLOCK_MONOTONIC, &step.until);
  return failed == ETIMEDOUT && !step.last ? 0 : failed;
}

__attribute__((visibility("default"))) int
pthread_mutex_timedlock(pthread_mutex_t* mutex,
                        const timespec* until) noexcept {
  for (;;) {
    const auto step = step_to(*until);
    const int failed =
        pthread_mutex_clocklock(mutex, CLOCK_MONOTONIC, &step.until);
    if (failed != ETIMEDOUT || step.last)
      return failed;
  }
}

__attribute__((visibility("default"))) int
sem_timedwait(sem_t* what, const timespec* until) {
  for (;;) {
    const auto step = step_to(*until);
    const int failed = sem_clockwait(what, CLOCK_MONOTONIC, &step.until);
    if (failed == 0 || errno != ETIMEDOUT || step.last)
      return failed;
  }
}

__attribute__((visibility("default"))) int
clock_gettime(clockid_t clock, timespec* now) noexcept {
  if (clock != CLOCK_REALTIME)
    return static_cast<int>(syscall(SYS_clock_gettime, clock, now));
  *now = wall_time();
  return 0;
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
