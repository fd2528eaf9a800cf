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
/// its own database, which Fast DDS leaves to a thread. Until then Fast DDS
/// 2.9.1 must not know of a remote server: the timer that greets those looks
/// the server itself up, and ends the process when it is not there.
///
/// We ask as a client does (discovery_probe.hpp): what the server says of
/// itself comes from that database.
class server_readiness {
public:
  /// `announce` has the server send its own data to all whom it knows; by
  /// itself it takes 110 ms until it does that for a newcomer.
  server_readiness(const sockaddr_in& server, std::function<void()> announce);

  /// Takes the questions back. Whenever somebody leaves, Fast DDS greets the
  /// remote servers that do not know it yet.
  ~server_readiness();

  server_readiness(const server_readiness&) = delete;
  server_readiness& operator=(const server_readiness&) = delete;

  /// Blocks for `limit` at most; false when the server has not said by then
  /// who it is.
  bool wait(std::chrono::milliseconds limit);

private:
  using clock = std::chrono::steady_clock;

  void send(const std::vector<std::uint8_t>& bytes);

  /// Until the server has told its own data, or `deadline`.
  bool hear(clock::time_point deadline);

  sockaddr_in server_;
  std::function<void()> announce_;
  std::optional<udp_socket> socket_; // None: there is no free port.
  std::vector<guid_prefix> asked_;
};

} // namespace roscell
