// A cable that is longer than it looks: frames that a host sends arrive on the
// bridge some time later, those that it gets are passed at once. Stands for
// netem where the kernel lacks it.
//
// Usage: delay_line MILLISECONDS CABLE TAP [CABLE TAP]...
// CABLE is the outer end of a host's veth pair, attached to no bridge. TAP is
// made here, belongs on the bridge in the cable's place, and goes with this
// process. A line on stdout says that all are there. Needs root.

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <stdexcept>
#include <string>
#include <vector>

#include <fcntl.h>
#include <linux/if_packet.h>
#include <linux/if_tun.h>
#include <net/ethernet.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/epoll.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <sys/timerfd.h>
#include <unistd.h>

namespace {

using clock_type = std::chrono::steady_clock;

/// Offloading lets cables carry segments of up to 64 KiB and checksums that
/// are not computed yet. A header before each frame tells of both, at packet
/// sockets and TAPs alike.
constexpr std::size_t max_frame_bytes = 66 * 1024;

[[noreturn]] void fail(const std::string& what) {
  throw std::runtime_error{what + ": " + std::strerror(errno)};
}

int check(int result, const std::string& what) {
  if (result < 0)
    fail(what);
  return result;
}

/// A packet socket that gets what the host sends, and only that.
int open_cable(const std::string& name) {
  const int fd = check(::socket(AF_PACKET, SOCK_RAW | SOCK_NONBLOCK, 0), name);
  const int on = 1;
  for (const int option : {PACKET_VNET_HDR, PACKET_IGNORE_OUTGOING})
    check(::setsockopt(fd, SOL_PACKET, option, &on, sizeof on), name);
  sockaddr_ll address{};
  address.sll_family = AF_PACKET;
  address.sll_protocol = htons(ETH_P_ALL);
  address.sll_ifindex = static_cast<int>(::if_nametoindex(name.c_str()));
  if (address.sll_ifindex == 0)
    fail(name);
  check(::bind(fd, reinterpret_cast<sockaddr*>(&address), sizeof address),
        name);
  return fd;
}

int open_tap(const std::string& name) {
  const int fd =
      check(::open("/dev/net/tun", O_RDWR | O_NONBLOCK), "/dev/net/tun");
  ifreq request{};
  name.copy(request.ifr_name, IFNAMSIZ - 1);
  request.ifr_flags = IFF_TAP | IFF_NO_PI | IFF_VNET_HDR;
  check(::ioctl(fd, TUNSETIFF, &request), name);
  check(::ioctl(fd, TUNSETOFFLOAD, TUN_F_CSUM | TUN_F_TSO4 | TUN_F_TSO6), name);
  return fd;
}

/// Frames of one direction take so long on their way from `from` to `to`.
struct lane {
  int from;
  int to;
  clock_type::duration delay;
};

struct frame {
  clock_type::time_point due;
  int to;
  std::string bytes;
};

class delay_line {
public:
  explicit delay_line(std::chrono::milliseconds delay)
      : delay_(delay), epoll_(check(::epoll_create1(0), "epoll")),
        timer_(
            check(::timerfd_create(CLOCK_MONOTONIC, TFD_NONBLOCK), "timerfd")) {
    watch(timer_, 0);
  }

  void add(const std::string& cable, const std::string& tap) {
    const int host = open_cable(cable);
    const int bridge = open_tap(tap);
    lanes_.push_back({host, bridge, delay_});
    watch(host, lanes_.size());
    lanes_.push_back({bridge, host, {}});
    watch(bridge, lanes_.size());
  }

  void run() {
    for (;;) {
      epoll_event event{};
      const int ready = ::epoll_wait(epoll_, &event, 1, -1);
      if (ready < 0 && errno != EINTR)
        fail("epoll_wait");
      if (ready > 0 && event.data.u64 == 0)
        release();
      else if (ready > 0)
        receive(lanes_[event.data.u64 - 1]);
    }
  }

private:
  /// `number` is 0 for the timer, else that of a lane, counted from 1.
  void watch(int fd, std::uint64_t number) {
    epoll_event event{};
    event.events = EPOLLIN;
    event.data.u64 = number;
    check(::epoll_ctl(epoll_, EPOLL_CTL_ADD, fd, &event), "epoll_ctl");
  }

  void receive(const lane& on) {
    buffer_.resize(max_frame_bytes);
    const auto size = ::read(on.from, buffer_.data(), buffer_.size());
    if (size <= 0)
      return;
    buffer_.resize(static_cast<std::size_t>(size));
    if (on.delay == clock_type::duration::zero()) {
      pass(on.to, buffer_);
      return;
    }
    // All are delayed by the same time, so they leave in the order they came.
    queue_.push_back({clock_type::now() + on.delay, on.to, buffer_});
    if (queue_.size() == 1)
      arm();
  }

  void release() {
    std::uint64_t expirations = 0;
    if (::read(timer_, &expirations, sizeof expirations) < 0)
      return;
    while (!queue_.empty() && queue_.front().due <= clock_type::now()) {
      pass(queue_.front().to, queue_.front().bytes);
      queue_.pop_front();
    }
    if (!queue_.empty())
      arm();
  }

  /// A frame that cannot be passed is lost, as on any network.
  static void pass(int to, const std::string& bytes) {
    if (::write(to, bytes.data(), bytes.size()) < 0)
      return;
  }

  /// Wakes this process when the first frame is due.
  void arm() {
    using namespace std::chrono;
    const auto due = queue_.front().due.time_since_epoch();
    const auto whole = duration_cast<seconds>(due);
    itimerspec when{};
    when.it_value.tv_sec = whole.count();
    when.it_value.tv_nsec = duration_cast<nanoseconds>(due - whole).count();
    check(::timerfd_settime(timer_, TFD_TIMER_ABSTIME, &when, nullptr),
          "timerfd_settime");
  }

  const clock_type::duration delay_;
  const int epoll_;
  const int timer_;
  std::vector<lane> lanes_;
  std::deque<frame> queue_;
  std::string buffer_;
};

} // namespace

int main(int argc, char** argv) {
  if (argc < 4 || argc % 2 != 0) {
    std::fputs("usage: delay_line MILLISECONDS CABLE TAP [CABLE TAP]...\n",
               stderr);
    return 2;
  }
  try {
    delay_line line{std::chrono::milliseconds{std::atoi(argv[1])}};
    for (int i = 2; i < argc; i += 2)
      line.add(argv[i], argv[i + 1]);
    std::puts("ready");
    std::fflush(stdout);
    line.run();
  } catch (const std::exception& error) {
    std::fprintf(stderr, "delay_line: %s\n", error.what());
    return 1;
  }
}
