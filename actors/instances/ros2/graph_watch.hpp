#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/dds/ros_graph.hpp"
#include "messages/messages.hpp"

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// A program that is looked after.
struct watched_program {
  watch_endpoints request;
  endpoint_listener_actor listener;
  /// As it was told last; none: nothing yet.
  std::optional<std::vector<std::string>> missing;
};

/// Looks for programs in what the node's discovery server knows.
struct graph_watch_state {
  static constexpr const char* name = "graph-watch";

  std::shared_ptr<ros_graph> graph;
  std::map<std::string, watched_program> programs; ///< By instance.
};

/// The GRAPH WATCH. Messages: messages/inside/link.hpp; it has no errors, and
/// forgets who has ended. While the node has no discovery server it tells
/// nothing: nobody can be missing.
graph_watch_actor::behavior_type
graph_watch(graph_watch_actor::stateful_pointer<graph_watch_state> self,
            std::shared_ptr<ros_graph> graph);

} // namespace roscell
