#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/failure.hpp"
#include "messages/messages.hpp"
#include "roscell/node_config.hpp"
#include "roscell/node_facts.hpp"

#include <caf/actor_system.hpp>
#include <caf/expected.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// A node that runs: its root actor and where it can be reached.
struct running_node : node_facts {
  node_actor actor;            ///< `stop_node` ends it in order.
  event_log_actor events;      ///< The node's events, for whoever embeds it.
  request_router_actor router; ///< Takes requests as they come from outside.
  /// Who of the node's actors lives, also after `actor` has ended.
  std::shared_ptr<actor_directory> actors;
};

/// What the program that embeds a node adds to it.
struct node_additions {
  /// Descriptors of the skills whose instances are actors of this process.
  std::vector<std::string> actor_skills;
  /// Spawns what runs them; called again when it has died.
  std::function<runtime_actor(const actor_context&,
                              const container_listener_actor&)>
      make_actor_runtime;
  /// Looks at the node's host, on a thread of its own; null: it cannot be
  /// looked at from elsewhere.
  std::function<findings()> check_host;
  /// Has the program end this node and spawn it anew, since it has got an
  /// identity in place of its token; from any thread. Null: that counts from
  /// the next start on.
  std::function<void()> start_anew;
};

/// Starts a node inside `system`, which the caller owns. Blocks until its ports
/// are open. Neither installs signal handlers nor ends the process.
///
/// Errors: conflict (a port or the data directory is in use), unreachable (the
/// address is not of this host, the container engine that was asked for does
/// not answer), unauthorized (no permission on the engine's socket),
/// schema_violation (a bad option or descriptor, named).
caf::expected<running_node> spawn_node(caf::actor_system& system,
                                       const node_config& config,
                                       const node_additions& additions = {});

} // namespace roscell
