#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>
#include <vector>

/// What nodes tell the CELL COORDINATOR of their instances, and what they are
/// told to keep, stop and start.
namespace roscell {

/// Keeps, stops and starts instances on the coordination node itself as a
/// registration does for other nodes. Called once the tasks are restored.
void reconcile_own_node(coordinator_pointer self);

/// Takes up what a node that registers runs, and says what shall become of
/// each of its instances.
std::vector<instance_verdict> take_up_instances(coordinator_pointer self,
                                                const node_registration& node);

/// From a member or the local supervisor: each changes rows of its own node
/// only.
void on_instance_changed(coordinator_pointer self,
                         const instance_changed& event);

/// Whether a node has something that runs or will run.
bool has_instances(const cell_coordinator_state& st, const std::string& node);

} // namespace roscell
