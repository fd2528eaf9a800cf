#include "actors/edge/io/socket_address.hpp"

#include <arpa/inet.h>

#include <charconv>

namespace roscell {

namespace {

/// What a name server may be asked for.
constexpr size_t longest_name = 253;

constexpr std::string_view digits_and_dots = "0123456789.";
constexpr std::string_view name_letters =
    "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789.-_";

bool is_host_name(const std::string& text) {
  return !text.empty() && text.size() <= longest_name && text.front() != '-'
         && text.front() != '.'
         && text.find_first_not_of(name_letters) == std::string::npos
         && text.find_first_not_of(digits_and_dots) != std::string::npos;
}

/// Host and port, whatever the host looks like.
std::optional<socket_address> split(std::string_view text,
                                    uint16_t default_port) {
  socket_address result{std::string{text.substr(0, text.find(':'))},
                        default_port};
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

} // namespace

bool is_ipv4(const std::string& text) {
  in_addr ignored{};
  return inet_pton(AF_INET, text.c_str(), &ignored) == 1;
}

std::optional<socket_address> parse_socket_address(std::string_view text,
                                                   uint16_t default_port) {
  auto result = split(text, default_port);
  if (result && is_ipv4(result->address))
    return result;
  return std::nullopt;
}

std::optional<socket_address> parse_host_address(std::string_view text,
                                                 uint16_t default_port) {
  auto result = split(text, default_port);
  if (result && (is_ipv4(result->address) || is_host_name(result->address)))
    return result;
  return std::nullopt;
}

std::string to_string(const socket_address& x) {
  return x.address + ":" + std::to_string(x.port);
}

} // namespace roscell
