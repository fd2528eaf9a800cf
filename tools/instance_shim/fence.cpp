#include "tools/instance_shim/fence.hpp"

#include <fcntl.h>
#include <sys/timerfd.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>

namespace roscell::shim {

namespace {

std::int64_t boot_now_ms() {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<std::int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

/// Returns false with errno set where there is no whole number.
bool read_once(int file, std::int64_t& result) {
  const auto n = ::pread(file, &result, sizeof(result), 0);
  if (n >= 0 && n != static_cast<ssize_t>(sizeof(result)))
    errno = ENODATA;
  return n == static_cast<ssize_t>(sizeof(result));
}

/// A number that is just being written could be read half and be any time: it
/// counts when it is read twice. It is written every few seconds at most.
bool read_moment(const char* path, std::int64_t& result) {
  constexpr int attempts = 3;
  const auto file = ::open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (file < 0)
    return false;
  auto good = read_once(file, result);
  auto settled = false;
  for (auto i = 0; i < attempts && good && !settled; ++i) {
    const auto before = result;
    good = read_once(file, result);
    settled = before == result;
  }
  const auto why = good ? EAGAIN : errno;
  ::close(file);
  errno = why;
  return good && settled;
}

} // namespace

fence::~fence() {
  if (timer_ >= 0)
    ::close(timer_);
}

bool fence::hold(const char* path) {
  path_ = path;
  timer_ = ::timerfd_create(CLOCK_BOOTTIME, TFD_CLOEXEC | TFD_NONBLOCK);
  std::int64_t moment = 0;
  if (timer_ < 0 || !read_moment(path_, moment))
    return false;
  if (moment > boot_now_ms())
    return wait_until(moment);
  errno = ETIME;
  return false;
}

bool fence::has_passed() {
  std::int64_t moment = 0;
  return !read_moment(path_, moment) || moment <= boot_now_ms()
         || !wait_until(moment);
}

bool fence::wait_until(std::int64_t boot_ms) const {
  itimerspec when{};
  when.it_value.tv_sec = boot_ms / 1000;
  when.it_value.tv_nsec = boot_ms % 1000 * 1'000'000;
  return ::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr) == 0;
}

} // namespace roscell::shim
