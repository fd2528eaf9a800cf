#include "actors/edge/reach/udp_question.hpp"

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/io_core.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <fcntl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <utility>
#include <vector>

namespace roscell {

namespace {

using error = boost::system::error_code;
using clock = std::chrono::steady_clock;

constexpr int questions = 3;

std::optional<port_answer> meaning_of(int system_error) {
  switch (system_error) {
  case ECONNREFUSED:
    return port_answer::closed;
  case EHOSTUNREACH:
  case ENETUNREACH:
    return port_answer::unreachable;
  default:
    return std::nullopt;
  }
}

/// A socket that hears of closed ports although it is not connected: a server
/// may answer from another port than it listens on.
int open_socket(const std::string& local_address) {
  auto bound = udp_socket::bind(local_address, 0);
  const auto* socket = std::get_if<udp_socket>(&bound);
  if (socket == nullptr)
    return -1;
  const int on = 1;
  setsockopt(socket->fd(), IPPROTO_IP, IP_RECVERR, &on, sizeof(on));
  const auto own = socket->local();
  setsockopt(socket->fd(), IPPROTO_IP, IP_MULTICAST_IF, &own.sin_addr,
             sizeof(own.sin_addr));
  return fcntl(socket->fd(), F_DUPFD_CLOEXEC, 0);
}

/// One question, repeated until it is answered. Io thread only.
class asked_question : public io_component,
                       public std::enable_shared_from_this<asked_question> {
public:
  asked_question(std::shared_ptr<io_core> core, udp_question what,
                 std::function<void(udp_answer)> done)
      : core_(std::move(core)), what_(std::move(what)), done_(std::move(done)),
        socket_(core_->context()), timer_(core_->context()) {
    // nop
  }

  void run() {
    core_->adopt(shared_from_this());
    const int fd = open_socket(what_.local_address);
    if (fd < 0)
      return finish(port_answer::unreachable);
    socket_.assign(fd);
    wait();
    ask();
  }

  void on_io_stop() override {
    over_ = true;
    close();
  }

private:
  void ask() {
    if (over_)
      return;
    if (asked_++ == questions)
      return finish(port_answer::silent);
    sockaddr_in own{};
    socklen_t size = sizeof(own);
    getsockname(socket_.native_handle(), reinterpret_cast<sockaddr*>(&own),
                &size);
    const auto datagram = what_.ask(own);
    asked_at_ = clock::now();
    if (const auto why = send(datagram))
      return finish(*why);
    timer_.expires_after(what_.limit / questions);
    timer_.async_wait([self = shared_from_this()](error ec) {
      if (!ec)
        self->ask();
    });
  }

  void wait() {
    socket_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [self = shared_from_this()](error ec) {
                         if (!ec && !self->over_)
                           self->receive();
                       });
  }

  void receive() {
    std::array<std::uint8_t, 2048> datagram{};
    sockaddr_in from{};
    socklen_t from_size = sizeof(from);
    const auto size =
        recvfrom(socket_.native_handle(), datagram.data(), datagram.size(),
                 MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0) {
      if (const auto why = meaning_of(errno))
        return finish(*why);
      drop_errors();
    } else if (const auto answer = what_.judge(
                   datagram.data(), static_cast<size_t>(size), from)) {
      const std::chrono::duration<double, std::milli> span =
          clock::now() - asked_at_;
      return finish(*answer, span.count());
    }
    wait();
  }

  /// What is left in the queue of errors would wake the loop again and again.
  void drop_errors() {
    std::array<char, 512> control{};
    msghdr message{};
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    while (
        recvmsg(socket_.native_handle(), &message, MSG_ERRQUEUE | MSG_DONTWAIT)
        >= 0)
      message.msg_controllen = control.size();
  }

  std::optional<port_answer> send(const std::vector<std::uint8_t>& bytes) {
    if (sendto(socket_.native_handle(), bytes.data(), bytes.size(),
               MSG_DONTWAIT | MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&what_.to), sizeof(what_.to))
        >= 0)
      return std::nullopt;
    return meaning_of(errno);
  }

  void finish(port_answer x, double round_trip_ms = -1) {
    if (std::exchange(over_, true))
      return;
    const auto self = shared_from_this();
    if (socket_.is_open() && what_.farewell)
      for (const auto& datagram : what_.farewell())
        send(datagram);
    close();
    core_->guarded([&] { done_({x, round_trip_ms}); });
  }

  void close() {
    const auto self = shared_from_this();
    error ignored;
    socket_.close(ignored);
    timer_.cancel();
    core_->release(this);
  }

  std::shared_ptr<io_core> core_;
  udp_question what_;
  std::function<void(udp_answer)> done_;
  boost::asio::posix::stream_descriptor socket_;
  boost::asio::steady_timer timer_;
  clock::time_point asked_at_;
  int asked_ = 0;
  bool over_ = false;
};

} // namespace

void ask_udp(const std::shared_ptr<io_core>& core, udp_question what,
             std::function<void(udp_answer)> done) {
  core->post([core, what = std::move(what), done = std::move(done)]() mutable {
    std::make_shared<asked_question>(core, std::move(what), std::move(done))
        ->run();
  });
}

namespace {

using prefixes = std::shared_ptr<std::vector<guid_prefix>>;

std::vector<std::vector<std::uint8_t>> farewells(const prefixes& asked) {
  std::vector<std::vector<std::uint8_t>> result;
  for (const auto& prefix : *asked)
    result.push_back(probe_farewell(prefix));
  return result;
}

udp_question question_for(const sockaddr_in& server) {
  udp_question result;
  result.to = server;
  const auto asked = std::make_shared<std::vector<guid_prefix>>();
  // Another asker each time: a server answers each one once.
  result.ask = [asked](const sockaddr_in& own) {
    asked->push_back(make_probe_prefix());
    return probe_question(asked->back(), own);
  };
  result.judge =
      [server](const std::uint8_t* datagram, std::size_t size,
               const sockaddr_in& from) -> std::optional<port_answer> {
    const auto prefix = probe_answer(datagram, size);
    if (!prefix || from.sin_addr.s_addr != server.sin_addr.s_addr)
      return std::nullopt;
    return server_id_of(*prefix) ? port_answer::found
                                 : port_answer::unauthenticated_peer;
  };
  result.farewell = [asked] { return farewells(asked); };
  return result;
}

} // namespace

void ask_discovery_port(const std::shared_ptr<io_core>& core,
                        const std::string& local_address,
                        const socket_address& server,
                        std::chrono::milliseconds limit,
                        std::function<void(udp_answer)> done) {
  const auto to = to_socket_address(server.address, server.port);
  if (!to)
    return core->post([done = std::move(done)] {
      done({port_answer::unreachable, -1});
    });
  auto what = question_for(*to);
  what.local_address = local_address;
  what.limit = limit;
  ask_udp(core, std::move(what), std::move(done));
}

} // namespace roscell
