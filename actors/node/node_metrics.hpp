#pragma once

#include "actors/node/node_agent.hpp"

#include <caf/result.hpp>

/// INTERNAL to the node agent.
namespace roscell {

using node_agent_pointer = node_agent_actor::stateful_pointer<node_agent_state>;

/// What skills say of themselves, and what the host says of them. Nothing is
/// read unless somebody asks.
caf::result<figures_report> report_metrics(node_agent_pointer self);

} // namespace roscell
