#include "actors/edge/dds/rtps/server_question.hpp"

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/io_core.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>
#include <cerrno>
#include <optional>
#include <utility>
#include <vector>

#include <sys/socket.h>
#include <unistd.h>

namespace roscell {

namespace {

using error = boost::system::error_code;

/// How often it is asked in the time: datagrams get lost.
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
/// answers from another port than it listens on.
int open_socket(const std::string& local_address) {
  auto bound = udp_socket::bind(local_address, 0);
  const auto* socket = std::get_if<udp_socket>(&bound);
  if (socket == nullptr)
    return -1;
  const int on = 1;
  setsockopt(socket->fd(), IPPROTO_IP, IP_RECVERR, &on, sizeof(on));
  return dup(socket->fd());
}

/// One question, repeated until it is answered. Io thread only.
class server_question : public io_component,
                        public std::enable_shared_from_this<server_question> {
public:
  server_question(std::shared_ptr<io_core> core, const sockaddr_in& server,
                  std::function<void(port_answer)> done)
      : core_(std::move(core)), server_(server), done_(std::move(done)),
        socket_(core_->context()), timer_(core_->context()) {
    // nop
  }

  void run(int fd, std::chrono::milliseconds limit) {
    core_->adopt(shared_from_this());
    if (fd < 0)
      return finish(port_answer::unreachable);
    socket_.assign(fd);
    interval_ = limit / questions;
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
    if (static_cast<int>(asked_.size()) == questions)
      return finish(port_answer::silent);
    sockaddr_in own{};
    socklen_t size = sizeof(own);
    getsockname(socket_.native_handle(), reinterpret_cast<sockaddr*>(&own),
                &size);
    // Another asker each time: a server answers each one once.
    asked_.push_back(make_probe_prefix());
    if (const auto why = send(probe_question(asked_.back(), own)))
      return finish(*why);
    timer_.expires_after(interval_);
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
    } else if (const auto prefix =
                   probe_answer(datagram.data(), static_cast<size_t>(size));
               prefix && from.sin_addr.s_addr == server_.sin_addr.s_addr) {
      return finish(server_id_of(*prefix) ? port_answer::found
                                          : port_answer::stranger);
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
               reinterpret_cast<const sockaddr*>(&server_), sizeof(server_))
        >= 0)
      return std::nullopt;
    return meaning_of(errno);
  }

  void finish(port_answer x) {
    if (std::exchange(over_, true))
      return;
    const auto self = shared_from_this();
    if (socket_.is_open())
      for (const auto& prefix : asked_)
        send(probe_farewell(prefix));
    close();
    core_->guarded([&] { done_(x); });
  }

  void close() {
    const auto self = shared_from_this();
    error ignored;
    socket_.close(ignored);
    timer_.cancel();
    core_->release(this);
  }

  std::shared_ptr<io_core> core_;
  sockaddr_in server_;
  std::function<void(port_answer)> done_;
  boost::asio::posix::stream_descriptor socket_;
  boost::asio::steady_timer timer_;
  std::chrono::milliseconds interval_{0};
  std::vector<guid_prefix> asked_;
  bool over_ = false;
};

} // namespace

void ask_discovery_port(const std::shared_ptr<io_core>& core,
                        const std::string& local_address,
                        const socket_address& server,
                        std::chrono::milliseconds limit,
                        std::function<void(port_answer)> done) {
  core->post(
      [core, local_address, server, limit, done = std::move(done)]() mutable {
        const auto to = to_socket_address(server.address, server.port);
        if (!to)
          return done(port_answer::unreachable);
        std::make_shared<server_question>(core, *to, std::move(done))
            ->run(open_socket(local_address), limit);
      });
}

} // namespace roscell
