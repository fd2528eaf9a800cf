#pragma once

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/house/limits.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

namespace roscell {

struct cell_client_options {
  std::string server_address;        ///< IPv4 address of the discovery server.
  std::uint16_t server_port = 11811; ///< UDP.
  /// The local IPv4 address to use; empty for the one that reaches the server.
  std::string address;
  std::uint32_t domain_id = 0; ///< The ROS domain of the cell, 0 to 232.
  std::string
      announcement; ///< At most `limits::discovery::announcement_bytes`.
  /// Short: to one whose farewell got lost the server sends some 6 kB/s until
  /// the lease is over. A client is there for as long as its node joins only.
  std::chrono::seconds lease{20};
  std::chrono::seconds announcement_period{6}; ///< Shorter than the lease.
};

/// What a client learned of its server.
struct server_sighting {
  std::uint8_t server_id = 0;
  guid_prefix prefix{};
  std::string announcement; ///< USER_DATA as it came, foreign bytes included.
};

/// Called on threads of Fast DDS or of the client, one at a time for one
/// client. They must not call the client.
struct cell_client_events {
  /// The server is found, or its announcement changed.
  std::function<void(const server_sighting&)> on_server;
  /// The server said farewell, or was silent for its lease. The client now
  /// looks for it again.
  std::function<void()> on_server_lost;
  /// The server is not found yet, and why. Called when the reason changes.
  std::function<void(const std::string&)> on_waiting;
  /// The server is there, and this host has no participant to spare for it.
  std::function<void(const std::string&)> on_trouble;
};

/// Keeps this process registered with the discovery server at one address.
///
/// It first asks the address for its server id (discovery_probe.hpp), with
/// 20 ms between the first questions and `max_probe_interval` between the later
/// ones, and creates the CLIENT participant only when there is an answer: that
/// takes milliseconds, and looking for a server that is not there costs about
/// 140 B/s, where a CLIENT of Fast DDS would send up to 34 kB/s for ever.
/// When the server is lost it deletes the participant and asks again.
///
/// A server that is killed (no farewell) and starts again at the same address
/// within the lease is not noticed: it learns of us within
/// `announcement_period`, but its new announcement is taken for the one that is
/// known. So whoever notices that the server's process ended, by the end of the
/// session with it, calls `renew`.
class cell_client {
public:
  static constexpr std::chrono::milliseconds max_probe_interval{2000};

  /// Starts to look for the server; never waits for it. Refused with
  /// `unreachable` (no such local address, or no route) or `schema_violation`
  /// (an option is out of bounds).
  static edge_result<std::unique_ptr<cell_client>>
  open(const cell_client_options& options, cell_client_events events);

  /// Calls `close`.
  ~cell_client();

  cell_client(const cell_client&) = delete;
  cell_client& operator=(const cell_client&) = delete;

  /// Leaves the server, if it is registered, and looks for it again, without
  /// `on_server_lost`. `on_server` is called with what it finds then.
  void renew();

  /// Says farewell to the server and ends. Takes a few milliseconds. No event
  /// is called any more when it returns.
  void close();

private:
  class impl;
  explicit cell_client(std::unique_ptr<impl> x);
  std::unique_ptr<impl> impl_;
};

} // namespace roscell
