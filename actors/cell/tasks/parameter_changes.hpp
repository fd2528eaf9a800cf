#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does to change parameters of what runs. Its node
/// has the program take them first; then they are written down in the task, so
/// that whoever starts the step again starts it with these. Where the second
/// comes to nothing the node is told the former ones again: what is written
/// down counts.
namespace roscell {

/// Errors: see `cell_coordinator_actor`.
caf::result<parameters_changed>
change_parameters(coordinator_pointer self, const parameter_change& request);

/// A node has registered, and may have been told what was not written down: it
/// is told what its tasks say. What works with that already does nothing.
void restate_parameters(coordinator_pointer self,
                        const node_registration& node);

} // namespace roscell
