#include "actors/edge/io/socket_address.hpp"

#include <arpa/inet.h>

#include <charconv>

namespace roscell {

std::optional<socket_address> parse_socket_address(std::string_view text,
                                                   uint16_t default_port) {
  socket_address result{std::string{text.substr(0, text.find(':'))},
                        default_port};
  in_addr ignored{};
  if (inet_pton(AF_INET, result.address.c_str(), &ignored) != 1)
    return std::nullopt;
  if (const auto colon = text.find(':'); colon != std::string_view::npos) {
    const auto digits = text.substr(colon + 1);
    const auto* end = digits.data() + digits.size();
    const auto read = std::from_chars(digits.data(), end, result.port);
    if (read.ec != std::errc{} || read.ptr != end)
      return std::nullopt;
  }
  if (result.port == 0)
    return std::nullopt;
  return result;
}

std::string to_string(const socket_address& x) {
  return x.address + ":" + std::to_string(x.port);
}

} // namespace roscell
