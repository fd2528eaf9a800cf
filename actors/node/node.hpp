#pragma once

#include "actors/instances/skills/current_skills.hpp"
#include "actors/node/node_edges.hpp"
#include "actors/requests/request_context.hpp"
#include "messages/messages.hpp"

#include <caf/actor.hpp>

#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// What the node actor holds.
struct node_parts {
  actor_context context;
  node_config config;
  std::shared_ptr<node_edges> edges;
  std::shared_ptr<directory_lock> lock;
  std::shared_ptr<sqlite_store> database; ///< Only to see what was written.
  std::shared_ptr<node_services> services;
  node_identity identity;
  local_agent_actor agent;
  shared_skills skills;
  skill_watcher_actor watcher;
  request_router_actor router;
  std::string limits; ///< What holds instances to their limits, or why none.
  std::vector<caf::actor> children; ///< In the order of their start.
};

/// Owns everything that runs on this machine.
struct node_state_data {
  static constexpr const char* name = "node";

  node_parts parts;
  int64_t started_unix_ms = 0;
  bool stopping = false;
  size_t open_children = 0;
  caf::error end_reason; ///< None after an orderly stop.
};

using node_pointer = node_actor::stateful_pointer<node_state_data>;

/// The NODE. Messages: messages/inside/requests.hpp. An exit message ends it as
/// `stop_node` does, but without leaving its cell, which expects it back with
/// its instances. It ends after its children, which use its sockets. A child
/// that dies takes the node with it: whoever runs it starts it again, and it
/// finds its instances.
node_actor::behavior_type node(node_pointer self, const node_parts& parts);

} // namespace roscell
