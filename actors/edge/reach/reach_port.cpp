#include "actors/edge/reach/reach_port.hpp"

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <boost/asio/posix/stream_descriptor.hpp>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace roscell {

namespace {

constexpr std::string_view magic = "ROSCELL";
constexpr std::size_t signed_size = 24;
constexpr char question_mark = '?';
constexpr char answer_mark = '!';

reach_bytes encode(char mark, std::string_view nonce, const digest& key) {
  reach_bytes result{};
  auto* end = std::copy(magic.begin(), magic.end(), result.data());
  *end++ = mark;
  end = std::copy(nonce.begin(), nonce.end(), end);
  const auto mac = hmac_sha256(as_bytes(key), {result.data(), signed_size});
  std::copy_n(as_bytes(mac).begin(), reach_packet_size - signed_size, end);
  return result;
}

std::string_view view(const reach_bytes& x) {
  return {x.data(), x.size()};
}

std::string_view view(const reach_nonce& x) {
  return {x.data(), x.size()};
}

/// The nonce of a datagram with that mark; empty if it is none, or forged.
std::string_view authentic_nonce(std::string_view datagram, char mark,
                                 const digest& key) {
  if (datagram.size() < reach_packet_size
      || datagram.substr(0, magic.size()) != magic
      || datagram[magic.size()] != mark)
    return {};
  const auto nonce =
      datagram.substr(magic.size() + 1, signed_size - magic.size() - 1);
  const auto genuine = encode(mark, nonce, key);
  return equal_in_constant_time(datagram.substr(0, reach_packet_size),
                                view(genuine))
             ? nonce
             : std::string_view{};
}

} // namespace

digest reach_key(std::string_view site_token) {
  return hmac_sha256(site_token, "roscell reach 1");
}

reach_nonce make_reach_nonce() {
  reach_nonce result{};
  const auto bytes = random_bytes(result.size());
  std::copy(bytes.begin(), bytes.end(), result.begin());
  return result;
}

std::vector<std::uint8_t> reach_question(const reach_nonce& nonce,
                                         const digest& key, std::size_t size) {
  const auto bytes = encode(question_mark, view(nonce), key);
  std::vector<std::uint8_t> result(bytes.begin(), bytes.end());
  result.resize(std::max(size, reach_packet_size));
  return result;
}

std::optional<reach_bytes> reach_answer(std::string_view datagram,
                                        std::string_view site_token) {
  if (site_token.empty() || datagram.substr(0, magic.size()) != magic)
    return std::nullopt;
  const auto key = reach_key(site_token);
  const auto nonce = authentic_nonce(datagram, question_mark, key);
  if (nonce.empty())
    return std::nullopt;
  return encode(answer_mark, nonce, key);
}

bool is_reach_answer(std::string_view datagram, const reach_nonce& nonce,
                     const digest& key) {
  return authentic_nonce(datagram, answer_mark, key) == view(nonce);
}

namespace {

using error = boost::system::error_code;

/// PB and DG of RTPS 2.3, 9.6.1.1.
constexpr unsigned first_dds_port = 7400;
constexpr unsigned domain_ports = 250;

/// Where skills begin to look for a free port
/// (skills/ros2/participant_qos.cpp): they try every other one.
constexpr unsigned first_skill_place = 90;
constexpr unsigned skill_port_step = 2;
constexpr unsigned places = 80;

/// Datagrams taken in a row before other handlers get their turn.
constexpr int burst = 64;

/// The longest datagram of UDP.
constexpr std::size_t longest_datagram = 65'535;

/// The socket on the io thread.
class reach_port_core : public io_component,
                        public std::enable_shared_from_this<reach_port_core> {
public:
  reach_port_core(std::shared_ptr<io_core> core, int fd,
                  const reach_port_options& options)
      : core_(std::move(core)), socket_(core_->context(), fd),
        site_(options.site), datagram_(longest_datagram) {
    inet_pton(AF_INET, options.address.c_str(), &own_);
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
    if (const auto answer = reach_answer(
            {datagram_.data(), static_cast<size_t>(size)}, site_.text()))
      send(*answer, from);
    return true;
  }

  /// From the node's address, by which the others know it: the kernel would
  /// choose another one of this host.
  void send(reach_bytes answer, sockaddr_in to) {
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(in_pktinfo))> control{};
    iovec bytes{answer.data(), answer.size()};
    msghdr message{};
    message.msg_name = &to;
    message.msg_namelen = sizeof(to);
    message.msg_iov = &bytes;
    message.msg_iovlen = 1;
    message.msg_control = control.data();
    message.msg_controllen = control.size();
    auto* header = CMSG_FIRSTHDR(&message);
    header->cmsg_level = IPPROTO_IP;
    header->cmsg_type = IP_PKTINFO;
    header->cmsg_len = CMSG_LEN(sizeof(in_pktinfo));
    in_pktinfo from{};
    from.ipi_spec_dst = own_;
    std::memcpy(CMSG_DATA(header), &from, sizeof(from));
    ::sendmsg(socket_.native_handle(), &message, MSG_DONTWAIT | MSG_NOSIGNAL);
  }

  std::shared_ptr<io_core> core_;
  boost::asio::posix::stream_descriptor socket_;
  site_secret site_;
  in_addr own_{};
  std::vector<char> datagram_;
};

class reach_port_handle : public reach_port {
public:
  void add(std::shared_ptr<reach_port_core> socket, uint16_t port) {
    socket->core()->post([socket] { socket->run(); });
    sockets_.push_back(std::move(socket));
    port_ = port;
  }

  ~reach_port_handle() override {
    for (const auto& socket : sockets_)
      socket->core()->post([socket] { socket->close(); });
  }

  uint16_t port() const override {
    return port_;
  }

private:
  std::vector<std::shared_ptr<reach_port_core>> sockets_;
  uint16_t port_ = 0;
};

/// What comes by multicast comes to no socket that is bound to one address. A
/// host without multicast does without.
void join_group(int fd, const std::string& address) {
  ip_mreq request{};
  inet_pton(AF_INET, discovery_group, &request.imr_multiaddr);
  inet_pton(AF_INET, address.c_str(), &request.imr_interface);
  setsockopt(fd, IPPROTO_IP, IP_ADD_MEMBERSHIP, &request, sizeof(request));
  const int off = 0;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &off, sizeof(off));
}

/// The first port that is free, of every other one from `first` on.
std::optional<bound_port> bind_from(unsigned first) {
  for (unsigned i = 0; i < places; ++i) {
    const auto port = first + skill_port_step * i;
    if (port > std::numeric_limits<uint16_t>::max())
      break;
    const auto bound = bind_udp("0.0.0.0", static_cast<uint16_t>(port));
    if (const auto* socket = std::get_if<bound_port>(&bound))
      return *socket;
  }
  return std::nullopt;
}

/// Where the next skill of this host will listen.
unsigned next_skill_port(unsigned first) {
  const auto place = bind_from(first);
  if (!place)
    return first;
  const unique_fd left_to_it{place->fd};
  return place->port;
}

} // namespace

uint16_t first_data_port(unsigned domain_id) {
  return static_cast<uint16_t>(first_dds_port + domain_ports * domain_id
                               + first_skill_place + 1);
}

uint16_t first_data_port_beside(uint16_t data_port) {
  return data_port < first_dds_port
             ? uint16_t{0}
             : first_data_port((data_port - first_dds_port) / domain_ports);
}

edge_result<std::unique_ptr<reach_port>>
reach_port::open(io_thread& io, const reach_port_options& options) {
  auto result = std::make_unique<reach_port_handle>();
  const auto add = [&](const bound_port& bound) {
    join_group(bound.fd, options.address);
    result->add(std::make_shared<reach_port_core>(io.core(), bound.fd, options),
                bound.port);
  };
  const auto first = first_data_port(options.domain_id);
  const auto low = bind_udp("0.0.0.0", first);
  if (const auto* bound = std::get_if<bound_port>(&low))
    add(*bound);
  // The port of the next skill is left to it: the one behind is as good.
  const auto next = next_skill_port(first - 1U) + 1U;
  if (result->port() != next)
    if (const auto high = bind_from(next))
      add(*high);
  if (result->port() != 0)
    return result;
  return edge_error{error_code::conflict,
                    "none of the DDS ports of domain "
                        + std::to_string(options.domain_id) + " is free",
                    ""};
}

} // namespace roscell
