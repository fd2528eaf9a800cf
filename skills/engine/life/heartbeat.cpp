#include "skills/engine/life/heartbeat.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/timerfd.h>

#include <cerrno>
#include <cstdint>
#include <system_error>

namespace roscell::engine {

namespace {

/// The counter of an event or timer descriptor, reset to 0.
void drain(int fd) {
  std::uint64_t count = 0;
  [[maybe_unused]] auto n = ::read(fd, &count, sizeof(count));
}

unique_fd checked(int fd) {
  if (fd < 0)
    throw std::system_error(errno, std::generic_category(), "heartbeat");
  return unique_fd{fd};
}

} // namespace

heartbeat::heartbeat(const notify_socket& socket, liveness& alive,
                     status_function status)
    : socket_(socket), alive_(alive), status_(std::move(status)),
      last_status_(liveness::clock::now()),
      timer_(checked(
          ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK))),
      wake_(checked(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))) {
  using namespace std::chrono;
  auto half = duration_cast<nanoseconds>(alive_.period() / 2);
  auto whole = duration_cast<seconds>(half);
  itimerspec every{};
  every.it_interval.tv_sec = whole.count();
  every.it_interval.tv_nsec = (half - whole).count();
  every.it_value = every.it_interval;
  ::timerfd_settime(timer_.get(), 0, &every, nullptr);
  thread_ = std::thread{[this] { run(); }};
}

heartbeat::~heartbeat() {
  stop_.set();
  thread_.join();
}

void heartbeat::beat_now() noexcept {
  std::uint64_t one = 1;
  [[maybe_unused]] auto n = ::write(wake_.get(), &one, sizeof(one));
}

void heartbeat::run() {
  pollfd waited[] = {{stop_.fd(), POLLIN, 0},
                     {timer_.get(), POLLIN, 0},
                     {wake_.get(), POLLIN, 0}};
  for (;;) {
    if (::poll(waited, 3, -1) < 1)
      continue; // Interrupted by a signal.
    if (waited[0].revents != 0)
      return;
    drain(timer_.get());
    drain(wake_.get());
    beat();
  }
}

void heartbeat::beat() {
  auto now = liveness::clock::now();
  if (!alive_.allows_beat(now))
    return;
  std::string state = "READY=1\nWATCHDOG=1";
  if (now - last_status_ >= std::chrono::seconds{1}) {
    last_status_ = now;
    state += "\nSTATUS=" + status_();
  }
  socket_.send(state);
}

} // namespace roscell::engine
