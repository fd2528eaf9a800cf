#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

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

/// Asks the system for the IPv4 address of a host without waiting; a host that
/// is an address already is answered at once. `done` is called once, on the io
/// thread, within `limit`. Errors: `unreachable` (there is no such name),
/// `timeout`, `conflict` (too many are being looked up). From any thread.
void look_up_host(const std::shared_ptr<io_core>& core, const std::string& host,
                  std::chrono::milliseconds limit,
                  std::function<void(edge_result<std::string>)> done);

/// The same for a thread that may wait.
edge_result<std::string> await_host(const std::string& host,
                                    std::chrono::milliseconds limit);

/// Hosts in numbers, as far as their names resolve.
struct resolved_hosts {
  std::vector<std::string> addresses; ///< As they came: "ADDR[:PORT]".
  std::string problem; ///< Of the names that do not; empty: there are none.
};

/// Looks up the hosts in "HOST[:PORT]", waiting no longer than `limit` for all
/// of them together.
resolved_hosts await_hosts(const std::vector<std::string>& hosts,
                           std::chrono::milliseconds limit);

} // namespace roscell
