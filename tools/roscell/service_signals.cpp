#include "tools/roscell/service_signals.hpp"

#include "tools/roscell/exit_code.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/signalfd.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <initializer_list>
#include <utility>

namespace roscell::cli {

namespace {

/// A descriptor by which these signals are read, and nothing else takes them.
int take_signals(std::initializer_list<int> numbers, int flags) {
  sigset_t wanted;
  sigemptyset(&wanted);
  for (const auto number : numbers)
    sigaddset(&wanted, number);
  pthread_sigmask(SIG_BLOCK, &wanted, nullptr);
  return signalfd(-1, &wanted, SFD_CLOEXEC | flags);
}

} // namespace

stop_signals::stop_signals(hangups about)
    : signal_fd_{take_signals({SIGINT, SIGTERM}, 0)}, event_fd_{eventfd(
                                                          0, EFD_CLOEXEC)} {
  if (about == hangups::heard)
    hangup_fd_ = take_signals({SIGHUP}, SFD_NONBLOCK);
  else
    std::signal(SIGHUP, SIG_IGN);
  if (signal_fd_ < 0 || event_fd_ < 0
      || (about == hangups::heard && hangup_fd_ < 0))
    throw command_error{exit_refused, "too many open files"};
}

stop_signals::~stop_signals() {
  close(signal_fd_);
  close(event_fd_);
  if (hangup_fd_ >= 0)
    close(hangup_fd_);
}

stop_signals::cause stop_signals::wait() {
  return poll_once(-1, -1, -1);
}

stop_signals::cause stop_signals::wait_for(std::chrono::milliseconds limit) {
  return poll_once(-1, -1, static_cast<int>(limit.count()));
}

stop_signals::cause stop_signals::wait_with(int fd,
                                            std::optional<time_point> until) {
  using namespace std::chrono;
  if (!until)
    return poll_once(fd, hangup_fd_, -1);
  // Rounded up: what is due then is to be due afterwards.
  const auto left = ceil<milliseconds>(*until - steady_clock::now());
  return poll_once(fd, hangup_fd_,
                   static_cast<int>(std::max(left, 0ms).count()));
}

void stop_signals::end() {
  eventfd_write(event_fd_, 1);
}

void stop_signals::renew() {
  renewing_ = true;
  end();
}

stop_signals::cause stop_signals::poll_once(int fd, int hangup_fd,
                                            int timeout_ms) {
  // A negative descriptor is passed over.
  std::array<pollfd, 4> fds{{{event_fd_, POLLIN, 0},
                             {signal_fd_, POLLIN, 0},
                             {hangup_fd, POLLIN, 0},
                             {fd, POLLIN, 0}}};
  if (poll(fds.data(), fds.size(), timeout_ms) <= 0)
    return cause::timeout;
  if (fds[0].revents != 0) {
    eventfd_t ends = 0;
    eventfd_read(event_fd_, &ends);
    return renewing_.exchange(false) ? cause::renewal : cause::ended;
  }
  signalfd_siginfo taken{};
  if (fds[1].revents != 0)
    return read(signal_fd_, &taken, sizeof taken) > 0 ? cause::signal
                                                      : cause::timeout;
  if (fds[2].revents == 0)
    return cause::news;
  while (read(hangup_fd, &taken, sizeof taken) > 0) {
  }
  return cause::hangup;
}

readiness::readiness(int fd) : fd_{fd} {
  constexpr auto variable = "NOTIFY_SOCKET";
  if (const auto* path = std::getenv(variable)) {
    socket_ = path;
    unsetenv(variable);
  }
}

void readiness::waiting(const std::string& why) {
  waited_ = true;
  notify("READY=1\nSTATUS=" + why);
}

void readiness::ready() {
  notify(std::exchange(waited_, false) ? "READY=1\nSTATUS=" : "READY=1");
  if (fd_ < 0)
    return;
  constexpr char line[] = "READY=1\n";
  // A reader that has gone does not want to know.
  [[maybe_unused]] const auto written = ::write(fd_, line, sizeof line - 1);
  ::close(std::exchange(fd_, -1));
}

void readiness::stopping() {
  notify("STOPPING=1");
}

void readiness::notify(const std::string& state) const {
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  if (socket_.empty() || socket_.size() >= sizeof address.sun_path)
    return;
  std::memcpy(address.sun_path, socket_.data(), socket_.size());
  auto size = offsetof(sockaddr_un, sun_path) + socket_.size();
  if (socket_.front() == '@')
    address.sun_path[0] = '\0'; // The abstract namespace.
  else
    ++size;
  const int fd = socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0)
    return;
  sendto(fd, state.data(), state.size(), MSG_NOSIGNAL,
         reinterpret_cast<const sockaddr*>(&address),
         static_cast<socklen_t>(size));
  close(fd);
}

} // namespace roscell::cli
