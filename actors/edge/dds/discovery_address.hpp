#pragma once

#include "actors/edge/io/edge_error.hpp"

#include <cstdint>
#include <optional>
#include <string>

#include <netinet/in.h>

/// INTERNAL to this folder.
namespace roscell {

/// A UDP socket that closes itself.
class udp_socket {
public:
  /// A socket that does not block, on one of this host's addresses. Refused
  /// with `unreachable` when no interface has the address, with `conflict`
  /// when the port is taken, with `unauthorized` when it is a privileged one.
  /// Port 0 means any free one.
  static edge_result<udp_socket> bind(const std::string& address,
                                      std::uint16_t port);

  /// Takes `fd` over.
  explicit udp_socket(int fd);

  udp_socket(udp_socket&& other) noexcept;
  udp_socket& operator=(udp_socket&& other) noexcept;
  ~udp_socket();

  int fd() const {
    return fd_;
  }

  sockaddr_in local() const;

private:
  int fd_ = -1;
};

/// As `free_port` of dds/server_addresses.hpp, on one address; refused as
/// `udp_socket::bind` is.
edge_result<std::uint16_t> free_port(const std::string& address,
                                     std::uint16_t first, unsigned places);

/// The socket address of dotted `address`, none if it is no IPv4 address of
/// one host.
std::optional<sockaddr_in> to_socket_address(const std::string& address,
                                             std::uint16_t port);

/// "10.0.0.5" of a socket address.
std::string address_text(const sockaddr_in& address);

/// "10.0.0.5:11811" of a socket address.
std::string endpoint_text(const sockaddr_in& address);

/// The local address from which this host reaches `remote`; `unreachable`
/// when it has no route.
edge_result<std::string> local_address_towards(const sockaddr_in& remote);

} // namespace roscell
