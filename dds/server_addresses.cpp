#include "dds/server_addresses.hpp"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <limits>

namespace roscell {

guid_prefix server_prefix(std::uint8_t id) {
  return {0x44, 0x53, id, 0x5f, 0x45, 0x50, 0x52, 0x4f, 0x53, 0x49, 0x4d, 0x41};
}

std::optional<std::uint8_t> server_id_of(const guid_prefix& prefix) {
  if (prefix != server_prefix(prefix[2]))
    return std::nullopt;
  return prefix[2];
}

std::string ros_discovery_server(std::uint8_t id, const std::string& address) {
  return std::string(id, ';') + address;
}

namespace {

using found_port = std::variant<std::uint16_t, std::error_code>;

/// Ports that the system offers are rarely taken on another address.
constexpr unsigned most_offers = 100;

std::error_code last_error() {
  return {errno, std::generic_category()};
}

/// The port that a socket on `address` gets, which is closed again; 0 asks for
/// any one.
found_port try_port(const std::string& address, std::uint16_t port) {
  sockaddr_in at{};
  at.sin_family = AF_INET;
  at.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &at.sin_addr) != 1)
    return std::make_error_code(std::errc::address_not_available);
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  if (fd < 0)
    return last_error();
  auto* generic = reinterpret_cast<sockaddr*>(&at);
  socklen_t size = sizeof(at);
  const bool bound =
      bind(fd, generic, size) == 0 && getsockname(fd, generic, &size) == 0;
  const auto error = last_error();
  close(fd);
  if (!bound)
    return error;
  return ntohs(at.sin_port);
}

/// The port on all of `addresses`.
found_port try_port(const std::vector<std::string>& addresses,
                    std::uint16_t port) {
  found_port result = port;
  for (const auto& address : addresses) {
    result = try_port(address, std::get<std::uint16_t>(result));
    if (std::holds_alternative<std::error_code>(result))
      break;
  }
  return result;
}

bool is_taken(const found_port& x) {
  const auto* error = std::get_if<std::error_code>(&x);
  return error != nullptr && *error == std::errc::address_in_use;
}

} // namespace

found_port free_port(const std::vector<std::string>& addresses,
                     std::uint16_t first, unsigned places) {
  constexpr unsigned last = std::numeric_limits<std::uint16_t>::max();
  for (unsigned place = 0; place < places; ++place) {
    const auto port = first + 2 * place;
    if (port > last)
      break;
    const auto found = try_port(addresses, static_cast<std::uint16_t>(port));
    if (!is_taken(found))
      return found;
  }
  auto found = try_port(addresses, 0);
  for (unsigned offer = 1; offer < most_offers && is_taken(found); ++offer)
    found = try_port(addresses, 0);
  return found;
}

} // namespace roscell
