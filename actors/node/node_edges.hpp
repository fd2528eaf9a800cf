#pragma once

#include "actors/builds/build_permits.hpp"
#include "actors/core/actor_context.hpp"
#include "actors/edge/dds/discovery_server.hpp"
#include "actors/edge/http/http_server.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/node/node_data.hpp"
#include "actors/site/known_nodes.hpp"
#include "messages/messages.hpp"

#include <caf/expected.hpp>

#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <string>

namespace roscell {

/// Passes requests on to the handler, once there is one.
class late_handler {
public:
  void set(http_handler handler);
  void operator()(http_request request, const responder& answer) const;

private:
  mutable std::mutex mutex_;
  http_handler handler_;
};

/// Everything of a node that is not an actor. It lives as long as the node, and
/// longer than all actors that use it.
struct node_edges {
  node_edges() = default;
  node_edges(const node_edges&) = delete;
  node_edges& operator=(const node_edges&) = delete;

  /// What still runs on the io thread uses the sockets, so it ends first.
  ~node_edges() {
    if (io)
      io->stop();
  }

  std::unique_ptr<io_thread> io;
  std::shared_ptr<late_handler> handler = std::make_shared<late_handler>();
  node_sockets sockets;
  /// Of the node's discovery server.
  std::shared_ptr<number_reserve> numbers;
  std::unique_ptr<cell_server> discovery; ///< Coordinators only.
  uint8_t server_id = 0;                  ///< Of `discovery`.
  std::string http_address;               ///< "ip:port"
  std::string socket_path;
  std::string discovery_server; ///< "ip:port"; coordinators only.
  /// What a ROS 2 program needs to be in the cell; coordinators only.
  std::map<std::string, std::string> environment;
  /// What the node's discovery server knows, whichever it is at present.
  std::shared_ptr<ros_graph> graph = std::make_shared<ros_graph>();
  /// Whom this coordinator knows.
  std::shared_ptr<known_nodes> known = std::make_shared<known_nodes>();
  /// Whom this node gives builds.
  std::shared_ptr<build_permits> permits = std::make_shared<build_permits>();
};

/// Opens the ports of a node. Errors: conflict (a port is in use), unreachable
/// (the address is not of this host), schema_violation (a path is too long).
caf::expected<std::shared_ptr<node_edges>>
open_edges(const node_config& config, const node_data& data,
           const actor_context& context);

/// Takes sessions for a coordinator from now on.
void admit_sessions(caf::actor_system& system, const actor_context& context,
                    node_edges& edges, const acceptor_identity& identity,
                    const site_secret& site,
                    const cell_coordinator_actor& coordinator);

/// Lets the heartbeats of all sessions keep a CPU sample fresh: the node is
/// awake for them anyway.
void mark_samples_at_heartbeats(node_edges& edges,
                                const resource_probe_actor& probe);

} // namespace roscell
