#pragma once

#include "actors/edge/dds/limits.hpp"
#include "actors/edge/dds/lives/number_reserve.hpp"
#include "actors/edge/dds/ros_graph.hpp"
#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// Another discovery server, which tells this one of its own clients.
struct remote_server {
  std::string address; ///< IPv4.
  std::uint16_t port = 11811;
  std::uint8_t id = 0;
};

struct cell_server_options {
  std::string address;         ///< An IPv4 address of this host.
  std::uint16_t port = 11811;  ///< UDP; 0 picks a free one.
  std::uint8_t server_id = 0;  ///< n of the GUID prefix 44.53.n.…
  std::uint32_t domain_id = 0; ///< The ROS domain, 0 to 232.
  std::string
      announcement; ///< At most `limits::discovery::announcement_bytes`.
  /// So long a silent client is remembered, and this server by its clients.
  std::chrono::seconds lease = limits::discovery::lease;
  std::chrono::seconds announcement_period =
      limits::discovery::announcement_period; ///< Shorter than the lease.
  std::optional<remote_server> remote;
  /// Goes on where an earlier life of this server ended; null: there was none.
  std::shared_ptr<number_reserve> numbers;
  std::shared_ptr<ros_graph> graph; ///< Null: one of its own.
};

/// A discovery server: the SERVER participant that ROS 2 programs of the cell
/// register with. The coordinator runs the cell's, and each member one for the
/// programs on its host, whose remote server is the cell's. It hears programs
/// of its own host at 127.0.0.1, too. Who only asks who is there is answered
/// with the announcement (rtps/probe_responder.hpp).
///
/// What is known of another server lasts as long as the session between the two
/// nodes, whoever of them ends or moves: at its end both `lose` each other, at
/// the next one they `meet`, and tell each other anew all that they know
/// (lives/discovery_guard.hpp). Programs do not notice: they go on to be known.
///
/// Fast DDS itself would take 110 ms to make itself known to a new client,
/// which a ROS 2 node's start waits for. We do so as soon as a client appears,
/// to all clients, as Fast DDS cannot do less; so only while there are at most
/// `max_greeted_clients`, and at most once in `greeting_interval`.
///
/// A killed server (no farewell) that starts again at the same address, with
/// the same `numbers`, finds its clients again as they announce themselves,
/// within their announcement period.
///
/// Two servers of one process must not have the same id: Fast DDS would mix
/// them up.
class cell_server {
public:
  static constexpr std::size_t max_greeted_clients = 32;
  static constexpr std::chrono::milliseconds greeting_interval{20};

  /// Starts the server. Refused with `conflict` (port in use), `unreachable`
  /// (no such address here), `unauthorized` (port below 1024),
  /// `schema_violation` (an option is out of bounds) or `internal` (Fast DDS
  /// refuses). `on_client` may be empty; it is called on Fast DDS's threads,
  /// for every participant of the cell, ROS 2 nodes included, and must not
  /// call this object.
  static edge_result<std::unique_ptr<cell_server>>
  open(const cell_server_options& options, on_sighting on_client = {});

  /// Calls `close`.
  ~cell_server();

  cell_server(const cell_server&) = delete;
  cell_server& operator=(const cell_server&) = delete;

  /// Where it listens.
  std::uint16_t port() const;

  /// What is known of the ends of ROS 2 topics, by remote servers' clients too.
  const std::shared_ptr<ros_graph>& graph() const;

  /// Another address or id of the remote server, which is lost first.
  void set_remote(const remote_server& remote);

  /// The session with the node of server `id` has begun: it is heard, and told
  /// all. One that had been met before is lost first. Of the remote server
  /// nothing is heard at first; others are heard unless they are lost.
  void meet(std::uint8_t id);

  /// The session with it has ended: nothing of it is heard any more. What it
  /// has told of goes on to be known.
  void lose(std::uint8_t id);

  /// By now its new life has told of what is there: what it has not told of is
  /// forgotten.
  void end_doubt(std::uint8_t id);

  /// Its node is not of the cell any more: all that it has told of ends.
  void forget(std::uint8_t id);

  /// Tells all clients, and who asks. `schema_violation` when it is too long.
  std::optional<edge_error> update_announcement(const std::string& bytes);

  /// Says farewell to the clients, who notice at once, and ends. Takes a few
  /// milliseconds. `on_client` is not called any more when it returns.
  void close();

private:
  class impl;
  explicit cell_server(std::unique_ptr<impl> x);
  std::unique_ptr<impl> impl_;
};

} // namespace roscell
