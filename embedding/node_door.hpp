#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/messages.hpp"
#include "roscell/node_actors.hpp"

#include <vector>

namespace roscell::embedding {

struct node_door_config {
  node_actor node;
  request_router_actor router;
  event_log_actor events;
};

/// Owns the way from the program's actors to the node's. It has a thread of its
/// own, and speaks to others without its own workers, so that actors of another
/// system run on that system's.
struct node_door_state {
  static constexpr const char* name = "node-door";

  node_door_config config;
  std::vector<event_listener_actor> passers; ///< One for each watcher.
};

/// The DOOR. Ends with its node. Messages: roscell/node_actors.hpp.
node_door_actor::behavior_type
node_door(node_door_actor::stateful_pointer<node_door_state> self,
          const node_door_config& config);

} // namespace roscell::embedding
