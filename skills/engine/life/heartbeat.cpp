#include "skills/engine/life/heartbeat.hpp"

#include "roscell/skill/errors.hpp"

#include <poll.h>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/timerfd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <system_error>
#include <utility>

namespace roscell::engine {

namespace {

/// The counter of an event or timer descriptor, reset to 0.
void drain(int fd) {
  std::uint64_t count = 0;
  [[maybe_unused]] auto n = ::read(fd, &count, sizeof(count));
}

/// Rounded up, so that who waits does not wake a moment too early.
int milliseconds_until(liveness::clock::time_point then,
                       liveness::clock::time_point now) {
  using std::chrono::milliseconds;
  return static_cast<int>(
      std::chrono::ceil<milliseconds>(std::max(then - now, {})).count());
}

liveness::clock::duration heartbeat_interval(const liveness& alive,
                                             bool measures) {
  constexpr std::chrono::seconds most_with_metrics{1};
  const auto half = alive.period() / 2;
  return measures ? std::min<liveness::clock::duration>(half, most_with_metrics)
                  : half;
}

timespec to_timespec(std::chrono::nanoseconds span) {
  const auto whole = std::chrono::duration_cast<std::chrono::seconds>(span);
  timespec result{};
  result.tv_sec = whole.count();
  result.tv_nsec = (span - whole).count();
  return result;
}

unique_fd checked(int fd) {
  if (fd < 0)
    throw std::system_error(errno, std::generic_category(), "heartbeat");
  return unique_fd{fd};
}

} // namespace

heartbeat::heartbeat(const notify_socket& socket, liveness& alive,
                     safe_state& safety, words reported)
    : socket_(socket), alive_(alive), safety_(safety),
      words_(std::move(reported)), last_status_(liveness::clock::now()),
      last_streams_(last_status_), safety_quiet_until_(last_status_),
      timer_(checked(
          ::timerfd_create(CLOCK_MONOTONIC, TFD_CLOEXEC | TFD_NONBLOCK))),
      wake_(checked(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK))) {
  itimerspec every{};
  every.it_interval = to_timespec(
      heartbeat_interval(alive_, static_cast<bool>(words_.streams)));
  every.it_value = every.it_interval;
  ::timerfd_settime(timer_.get(), 0, &every, nullptr);
  thread_ = std::thread{[this] { run(); }};
}

heartbeat::~heartbeat() {
  stop_.set();
  thread_.join();
}

void heartbeat::send_now() noexcept {
  std::uint64_t one = 1;
  [[maybe_unused]] auto n = ::write(wake_.get(), &one, sizeof(one));
}

void heartbeat::run() {
  pollfd waited[] = {{stop_.fd(), POLLIN, 0},
                     {timer_.get(), POLLIN, 0},
                     {wake_.get(), POLLIN, 0},
                     {safety_.fd(), POLLIN, 0}};
  for (;;) {
    const auto quiet =
        milliseconds_until(safety_quiet_until_, liveness::clock::now());
    // A descriptor below 0 is not looked at.
    waited[3].fd = quiet > 0 ? -1 : safety_.fd();
    if (::poll(waited, 4, quiet > 0 ? quiet : -1) < 1)
      continue; // Interrupted by a signal, or a word may be sent again.
    if (waited[0].revents != 0)
      return;
    const auto now = liveness::clock::now();
    if (waited[3].revents != 0)
      report_safety(now);
    if (waited[1].revents != 0 || waited[2].revents != 0)
      send_heartbeat(now);
  }
}

std::string heartbeat::safety_line() {
  // What changes after this is readable again.
  drain(safety_.fd());
  reported_safety_ = safety_.get();
  if (!reported_safety_)
    return {};
  return *reported_safety_ ? "ROSCELL_SAFE=1" : "ROSCELL_SAFE=0";
}

void heartbeat::report_safety(time_point now) {
  const auto before = reported_safety_;
  const auto line = safety_line();
  if (reported_safety_ == before)
    return;
  safety_quiet_until_ = now + least_word_pause;
  socket_.send(line);
}

void heartbeat::send_heartbeat(time_point now) {
  drain(timer_.get());
  drain(wake_.get());
  if (!alive_.allows_heartbeat(now))
    return;
  std::string state = "READY=1\nWATCHDOG=1";
  if (safety_.get())
    state += "\n" + safety_line();
  if (words_.streams && now - last_streams_ >= least_stream_pause) {
    last_streams_ = now;
    state += "\nROSCELL_STREAMS=" + words_.streams(now);
  }
  if (now - last_status_ >= std::chrono::seconds{1}) {
    last_status_ = now;
    state += "\n" + words_.status();
  }
  socket_.send(state);
}

void liveness::work_begins(clock::time_point now) {
  std::lock_guard guard{mutex_};
  busy_since_ = now;
}

bool liveness::work_ends() {
  std::lock_guard guard{mutex_};
  busy_since_.reset();
  return std::exchange(withheld_, false);
}

bool liveness::allows_heartbeat(clock::time_point now) {
  std::lock_guard guard{mutex_};
  withheld_ = busy_since_ && now - *busy_since_ >= period_ / 2;
  return !withheld_;
}

notify_socket::notify_socket(const std::string& name) {
  if (name.empty())
    return;
  auto known = name.front() == '/' || name.front() == '@';
  if (!known || name.size() < 2 || name.size() >= sizeof(address_.sun_path))
    throw start_error("NOTIFY_SOCKET must be an absolute path or '@' and a "
                      "name, of less than "
                      + std::to_string(sizeof(address_.sun_path))
                      + " bytes, but is '" + name + "'");
  address_.sun_family = AF_UNIX;
  std::copy(name.begin(), name.end(), address_.sun_path);
  auto size = offsetof(sockaddr_un, sun_path) + name.size();
  if (name.front() == '@')
    address_.sun_path[0] = '\0';
  else
    ++size; // A path includes its terminating zero.
  address_size_ = static_cast<unsigned>(size);
  fd_ = unique_fd{::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (!fd_)
    throw start_error(std::string{"cannot make a socket for NOTIFY_SOCKET: "}
                      + std::strerror(errno));
  timeval limit{1, 0};
  ::setsockopt(fd_.get(), SOL_SOCKET, SO_SNDTIMEO, &limit, sizeof(limit));
}

int notify_socket::send(const std::string& state) const {
  if (!fd_)
    return 0;
  // The address is looked up at each call: a restarted node has bound a new
  // socket to the same name.
  auto n =
      ::sendto(fd_.get(), state.data(), state.size(), MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&address_), address_size_);
  return n < 0 ? errno : 0;
}

} // namespace roscell::engine
