#pragma once

#include "actors/edge/dds/discovery_address.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <chrono>
#include <functional>
#include <optional>
#include <vector>

/// INTERNAL to this folder.
namespace roscell {

/// Waits for a discovery server of this process to have entered itself into
/// its own database, which Fast DDS leaves to a thread, and learns with which
/// words it introduces itself.
///
/// We ask as a client does (discovery_probe.hpp): what the server says of
/// itself comes from that database.
class server_readiness {
public:
  /// `announce` has the server send its own data to all whom it knows; by
  /// itself it takes 110 ms until it does that for a newcomer.
  server_readiness(const sockaddr_in& server, std::function<void()> announce);

  /// Takes the questions back.
  ~server_readiness();

  server_readiness(const server_readiness&) = delete;
  server_readiness& operator=(const server_readiness&) = delete;

  /// The message with which it introduces itself to anybody. Blocks for `limit`
  /// at most; none when the server has not said by then who it is.
  std::optional<std::vector<std::uint8_t>>
  wait(std::chrono::milliseconds limit);

private:
  using clock = std::chrono::steady_clock;

  void send(const std::vector<std::uint8_t>& bytes);

  /// Until the server has told its own data, or `deadline`.
  std::optional<std::vector<std::uint8_t>> hear(clock::time_point deadline);

  sockaddr_in server_;
  std::function<void()> announce_;
  std::optional<udp_socket> socket_; // None: there is no free port.
  std::vector<guid_prefix> asked_;
};

} // namespace roscell
