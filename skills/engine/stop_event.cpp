#include "roscell/skill/stop_event.hpp"
#include "roscell/skill/pacer.hpp"
#include "roscell/skill/safe_state.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <system_error>

namespace roscell::engine {

pacer::pacer(double rate_hz) : due_(stop_event::clock::now()) {
  using namespace std::chrono;
  // A rate near 0 would be a period that no clock can count.
  constexpr auto longest_s = duration<double>{hours{24}}.count();
  if (rate_hz > 0)
    period_ = duration_cast<stop_event::clock::duration>(
        duration<double>{std::min(1 / rate_hz, longest_s)});
}

bool pacer::wait(const stop_event& stop) {
  if (period_ == stop_event::clock::duration::zero())
    return true;
  if (stop.wait_until(due_))
    return false;
  due_ = std::max(due_, stop_event::clock::now()) + period_;
  return true;
}

bool pacer::take_turn() {
  auto now = stop_event::clock::now();
  if (now + period_ / 4 < due_)
    return false;
  due_ = std::max(due_, now) + period_;
  return true;
}

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

safe_state::safe_state() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

safe_state::~safe_state() {
  ::close(fd_);
}

void safe_state::set(bool safe) noexcept {
  const auto next = safe ? word::safe : word::unsafe;
  if (word_.exchange(next) == next)
    return;
  std::uint64_t one = 1;
  [[maybe_unused]] auto n = ::write(fd_, &one, sizeof(one));
}

std::optional<bool> safe_state::get() const noexcept {
  const auto last = word_.load();
  if (last == word::untold)
    return std::nullopt;
  return last == word::safe;
}

} // namespace roscell::engine
