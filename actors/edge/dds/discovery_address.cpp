#include "actors/edge/dds/discovery_address.hpp"

#include "actors/edge/host/interfaces.hpp"
#include "dds/server_addresses.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

namespace roscell {

namespace {

const sockaddr* generic(const sockaddr_in& address) {
  return reinterpret_cast<const sockaddr*>(&address);
}

edge_error bind_error(int error, const std::string& address,
                      std::uint16_t port) {
  auto text = std::to_string(port);
  switch (error) {
  case EADDRINUSE:
    return {error_code::conflict,
            "UDP port " + text + " on " + address + " is in use",
            "choose another port, or 0 for any free one"};
  case EADDRNOTAVAIL:
    return {error_code::unreachable,
            address + " is not an address of this host",
            "this host has: " + describe_interfaces(list_interfaces())};
  case EACCES:
    return {error_code::unauthorized,
            "UDP port " + text + " is reserved for the system",
            "choose a port above 1023"};
  default:
    return {error_code::internal,
            "cannot bind UDP port " + text + " on " + address + ": "
                + std::strerror(error),
            ""};
  }
}

} // namespace

udp_socket::udp_socket(int fd) : fd_(fd) {}

udp_socket::udp_socket(udp_socket&& other) noexcept
    : fd_(std::exchange(other.fd_, -1)) {}

udp_socket& udp_socket::operator=(udp_socket&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

udp_socket::~udp_socket() {
  if (fd_ >= 0)
    ::close(fd_);
}

edge_result<udp_socket> udp_socket::bind(const std::string& address,
                                         std::uint16_t port) {
  auto at = to_socket_address(address, port);
  // All of 127.0.0.0/8 can be bound, but Fast DDS wants an interface's own.
  if (!at || std::holds_alternative<edge_error>(resolve_interface(address)))
    return bind_error(EADDRNOTAVAIL, address, port);
  udp_socket result{
      socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0)};
  if (result.fd_ < 0 || ::bind(result.fd_, generic(*at), sizeof(*at)) != 0)
    return bind_error(errno, address, port);
  return result;
}

sockaddr_in udp_socket::local() const {
  sockaddr_in result{};
  socklen_t size = sizeof(result);
  getsockname(fd_, reinterpret_cast<sockaddr*>(&result), &size);
  return result;
}

edge_result<std::uint16_t> free_port(const std::string& address,
                                     std::uint16_t first, unsigned places) {
  // An address of no interface can be bound where it is a loopback one.
  if (std::holds_alternative<edge_error>(resolve_interface(address)))
    return bind_error(EADDRNOTAVAIL, address, first);
  const auto found = free_port(std::vector{address}, first, places);
  if (const auto* error = std::get_if<std::error_code>(&found))
    return bind_error(error->value(), address, first);
  return std::get<std::uint16_t>(found);
}

std::optional<sockaddr_in> to_socket_address(const std::string& address,
                                             std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1)
    return std::nullopt;
  auto host = ntohl(result.sin_addr.s_addr);
  if (host == INADDR_ANY || host == INADDR_BROADCAST || IN_MULTICAST(host))
    return std::nullopt;
  return result;
}

std::string address_text(const sockaddr_in& address) {
  std::array<char, INET_ADDRSTRLEN> text{};
  return inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size());
}

std::string endpoint_text(const sockaddr_in& address) {
  return address_text(address) + ':' + std::to_string(ntohs(address.sin_port));
}

edge_result<std::string> local_address_towards(const sockaddr_in& remote) {
  // Connecting a UDP socket sends nothing; it only asks the routing table.
  udp_socket asking{socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (connect(asking.fd(), generic(remote), sizeof(remote)) != 0)
    return edge_error{error_code::unreachable,
                      "there is no route to " + address_text(remote) + ": "
                          + std::strerror(errno),
                      "this host has: "
                          + describe_interfaces(list_interfaces())};
  return address_text(asking.local());
}

} // namespace roscell
