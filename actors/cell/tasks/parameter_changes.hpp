#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does to change parameters of what runs.
namespace roscell {

/// Errors: see `cell_coordinator_actor`.
caf::result<parameters_changed>
change_parameters(coordinator_pointer self, const parameter_change& request);

} // namespace roscell
