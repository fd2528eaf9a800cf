#include "actors/edge/dds/rtps/datagram_inlet.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include <arpa/inet.h>
#include <sys/socket.h>

namespace roscell {

namespace {

constexpr const char* own_host = "127.0.0.1";

void set_option(int fd, int level, int name, int value) {
  setsockopt(fd, level, name, &value, sizeof(value));
}

/// A socket that gets what is sent to a group over the interface of `address`.
std::optional<udp_socket> join(const std::string& group, std::uint16_t port,
                               const std::string& address) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  ip_mreq membership{};
  if (inet_pton(AF_INET, group.c_str(), &at.sin_addr) != 1
      || inet_pton(AF_INET, address.c_str(), &membership.imr_interface) != 1)
    return std::nullopt;
  membership.imr_multiaddr = at.sin_addr;
  udp_socket result{
      socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  set_option(result.fd(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (bind(result.fd(), reinterpret_cast<const sockaddr*>(&at), sizeof(at))
      != 0)
    return std::nullopt;
  setsockopt(result.fd(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership,
             sizeof(membership));
  return result;
}

} // namespace

datagram_inlet::datagram_inlet(inlet_options options)
    : options_(std::move(options)), thread_(dds_thread::shared()) {
  // nop
}

bool datagram_inlet::open(std::uint16_t port, on_datagram hear,
                          on_datagram hear_loopback) {
  std::vector<std::unique_ptr<entry>> ears;
  ears.push_back(listen_at(options_.address, port, std::move(hear)));
  if (ears.back() && options_.at_loopback && options_.address != own_host)
    ears.push_back(listen_at(own_host, port, std::move(hear_loopback)));
  if (!ears.back())
    return false;
  const std::lock_guard lock{mutex_};
  ports_[port] = std::move(ears);
  return true;
}

bool datagram_inlet::open_group(const std::string& group, std::uint16_t port,
                                on_datagram hear) {
  auto socket = join(group, port, options_.address);
  if (!socket)
    return false;
  auto ear = listen(*std::move(socket), std::move(hear));
  if (!ear)
    return false;
  const std::lock_guard lock{mutex_};
  ports_[port].push_back(std::move(ear));
  return true;
}

bool datagram_inlet::is_open(std::uint16_t port) const {
  const std::lock_guard lock{mutex_};
  return ports_.count(port) != 0;
}

bool datagram_inlet::close(std::uint16_t port) {
  // They end unlocked: each waits until it is not called any more.
  std::vector<std::unique_ptr<entry>> ears;
  const std::lock_guard lock{mutex_};
  const auto found = ports_.find(port);
  if (found == ports_.end())
    return false;
  ears = std::move(found->second);
  ports_.erase(found);
  return true;
}

std::unique_ptr<dds_thread::entry> datagram_inlet::listen(udp_socket socket,
                                                          on_datagram hear) {
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (const auto wanted = std::min(options_.buffer_bytes, most); wanted != 0)
    set_option(socket.fd(), SOL_SOCKET, SO_RCVBUF, static_cast<int>(wanted));
  return thread_->listen(std::move(socket), options_.max_bytes,
                         std::move(hear));
}

std::unique_ptr<dds_thread::entry>
datagram_inlet::listen_at(const std::string& address, std::uint16_t port,
                          on_datagram hear) {
  auto bound = udp_socket::bind(address, port);
  if (auto* socket = std::get_if<udp_socket>(&bound))
    return listen(std::move(*socket), std::move(hear));
  return nullptr;
}

} // namespace roscell
