#include "actors/edge/reach/reach_port.hpp"

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/listen_socket.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>

#include <cerrno>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

namespace roscell {

namespace {

using error = boost::system::error_code;

/// PB and DG of RTPS 2.3, 9.6.1.1.
constexpr unsigned first_dds_port = 7400;
constexpr unsigned domain_ports = 250;

/// Participants take ports from the first on, so the last ones are tried.
constexpr unsigned places = 50;

/// Datagrams taken in a row before other handlers get their turn.
constexpr int burst = 64;

/// The longest datagram of UDP.
constexpr std::size_t longest_datagram = 65'535;

/// The socket on the io thread.
class reach_port_core : public io_component,
                        public std::enable_shared_from_this<reach_port_core> {
public:
  reach_port_core(std::shared_ptr<io_core> core, int fd, const digest& key)
      : core_(std::move(core)), socket_(core_->context(), fd), key_(key),
        datagram_(longest_datagram) {
    // nop
  }

  const std::shared_ptr<io_core>& core() const {
    return core_;
  }

  void run() {
    core_->adopt(shared_from_this());
    wait();
  }

  void on_io_stop() override {
    close();
  }

  void close() {
    const auto self = shared_from_this();
    error ignored;
    socket_.close(ignored);
    core_->release(this);
  }

private:
  void wait() {
    socket_.async_wait(boost::asio::posix::stream_descriptor::wait_read,
                       [self = shared_from_this()](error ec) {
                         if (ec || !self->socket_.is_open())
                           return;
                         for (int i = 0; i < burst && self->answer_one(); ++i)
                           continue;
                         self->wait();
                       });
  }

  /// False if there is nothing more.
  bool answer_one() {
    sockaddr_in from{};
    socklen_t from_size = sizeof(from);
    const auto size =
        recvfrom(socket_.native_handle(), datagram_.data(), datagram_.size(),
                 MSG_DONTWAIT, reinterpret_cast<sockaddr*>(&from), &from_size);
    if (size < 0)
      return errno != EAGAIN;
    if (const auto answer =
            reach_answer({datagram_.data(), static_cast<size_t>(size)}, key_))
      ::sendto(socket_.native_handle(), answer->data(), answer->size(),
               MSG_DONTWAIT | MSG_NOSIGNAL,
               reinterpret_cast<const sockaddr*>(&from), from_size);
    return true;
  }

  std::shared_ptr<io_core> core_;
  boost::asio::posix::stream_descriptor socket_;
  digest key_;
  std::vector<char> datagram_;
};

class reach_port_handle : public reach_port {
public:
  reach_port_handle(std::shared_ptr<reach_port_core> socket, uint16_t port)
      : socket_(std::move(socket)), port_(port) {
    socket_->core()->post([socket = socket_] { socket->run(); });
  }

  ~reach_port_handle() override {
    socket_->core()->post([socket = socket_] { socket->close(); });
  }

  uint16_t port() const override {
    return port_;
  }

private:
  std::shared_ptr<reach_port_core> socket_;
  uint16_t port_;
};

/// What comes by multicast comes to no socket that is bound to one address. A
/// host without multicast does without.
void join_group(int fd, const std::string& address) {
  ip_mreq wish{};
  inet_pton(AF_INET, discovery_group, &wish.imr_multiaddr);
  inet_pton(AF_INET, address.c_str(), &wish.imr_interface);
  setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &wish, sizeof(wish));
  const int off = 0;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof(off));
}

} // namespace

edge_result<std::unique_ptr<reach_port>>
reach_port::open(io_thread& io, const reach_port_options& options) {
  const auto last =
      first_dds_port + domain_ports * options.domain_id + domain_ports - 1;
  for (unsigned i = 0; i < places; ++i) {
    const auto port = static_cast<uint16_t>(last - i);
    const auto bound = bind_udp("0.0.0.0", port);
    const auto* socket = std::get_if<bound_port>(&bound);
    if (socket == nullptr)
      continue;
    join_group(socket->fd, options.address);
    auto core =
        std::make_shared<reach_port_core>(io.core(), socket->fd, options.key);
    return std::make_unique<reach_port_handle>(std::move(core), port);
  }
  return edge_error{error_code::conflict,
                    "none of the last 50 DDS ports of domain "
                        + std::to_string(options.domain_id) + " is free",
                    ""};
}

} // namespace roscell
