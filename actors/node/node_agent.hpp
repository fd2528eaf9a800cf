#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/instances/secrets/secret_names.hpp"
#include "actors/node/reservation_table.hpp"
#include "messages/messages.hpp"

#include <caf/result.hpp>

#include <functional>
#include <map>
#include <string>
#include <vector>

namespace roscell {

struct node_agent_config {
  std::string node; ///< Its name.
  std::map<std::string, std::string> labels;
  std::vector<std::string> devices; ///< Offered besides those found.
  container_supervisor_actor supervisor;
  resource_probe_actor probe;
  /// Part of the cores that a new process gets beside busy programs.
  double cpu_floor = 0;
  std::vector<std::string> grants; ///< What it grants to skills.
  shared_secret_names secrets;     ///< Null: it keeps none.
};

/// Answers for the local node what a coordinator asks of it.
struct node_agent_state {
  static constexpr const char* name = "node-agent";

  node_agent_config config;
  reservation_table kept;
  serve_builds builds; ///< Invalid handles: this node gets none.
  uint64_t reports = 0;
};

/// The local NODE AGENT. Messages: messages/inside/agent.hpp.
local_agent_actor::behavior_type
node_agent(local_agent_actor::stateful_pointer<node_agent_state> self,
           const node_agent_config& config);

// INTERNAL to the node agent.

using node_agent_pointer =
    local_agent_actor::stateful_pointer<node_agent_state>;

/// What skills say of themselves, and what the host says of them. Nothing is
/// read unless somebody asks.
caf::result<figures_report> report_metrics(node_agent_pointer self);

/// Gets a build that a step needs, if it comes from other nodes; then calls one
/// of the two.
void with_build(node_agent_pointer self, const instance_deployment& request,
                const std::function<void()>& done,
                const std::function<void(const caf::error&)>& fail);

/// Gets a build that the cell counts on. Errors: as the BUILD FETCHER's.
caf::result<build_kept> keep_build(node_agent_pointer self,
                                   const build_keeping& request);

/// It goes from this node. Errors: conflict (it runs).
caf::result<build_released> release_build(node_agent_pointer self,
                                          const build_release& request);

} // namespace roscell
