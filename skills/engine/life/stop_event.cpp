#include "roscell/skill/stop_event.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace roscell::engine {

namespace {

timespec to_timespec(std::chrono::nanoseconds span) {
  using namespace std::chrono;
  span = std::max(span, nanoseconds{0});
  auto whole = duration_cast<seconds>(span);
  timespec result{};
  result.tv_sec = whole.count();
  result.tv_nsec = (span - whole).count();
  return result;
}

} // namespace

stop_event::stop_event() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

stop_event::~stop_event() {
  ::close(fd_);
}

void stop_event::set() noexcept {
  std::uint64_t one = 1;
  // The counter cannot overflow in practice, so the write cannot fail.
  [[maybe_unused]] auto n = ::write(fd_, &one, sizeof(one));
}

bool stop_event::is_set() const noexcept {
  pollfd waited{fd_, POLLIN, 0};
  return ::poll(&waited, 1, 0) == 1;
}

void stop_event::wait() const {
  pollfd waited{fd_, POLLIN, 0};
  while (::poll(&waited, 1, -1) < 1) {
    // Interrupted by a signal: wait on.
  }
}

bool stop_event::wait_until(clock::time_point deadline) const {
  pollfd waited{fd_, POLLIN, 0};
  for (;;) {
    auto left = to_timespec(deadline - clock::now());
    auto n = ::ppoll(&waited, 1, &left, nullptr);
    if (n >= 0)
      return n == 1;
  }
}

bool stop_event::wait_readable(int other) const {
  pollfd waited[] = {{fd_, POLLIN, 0}, {other, POLLIN, 0}};
  while (::poll(waited, 2, -1) < 1) {
    // Interrupted by a signal: wait on.
  }
  return (waited[0].revents & POLLIN) == 0;
}

} // namespace roscell::engine
