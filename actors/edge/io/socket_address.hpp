#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// An IPv4 address, or the name of a host, and a port, as `ADDR:PORT` says
/// them.
struct socket_address {
  std::string address;
  uint16_t port = 0;
};

/// Reads `ADDR` or `ADDR:PORT`; without a port, `default_port` is taken, and if
/// that is 0 a port is required. Nothing for any other text.
std::optional<socket_address> parse_socket_address(std::string_view text,
                                                   uint16_t default_port = 0);

/// The same for a host that may be named too, by up to 253 letters, digits,
/// '.', '-' and '_'. What consists of digits and dots is no name.
std::optional<socket_address> parse_host_address(std::string_view text,
                                                 uint16_t default_port = 0);

/// Whether that is an IPv4 address in numbers.
bool is_ipv4(const std::string& text);

std::string to_string(const socket_address& x);

} // namespace roscell
