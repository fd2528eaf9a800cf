#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does for sets of tasks.
namespace roscell {

/// Errors: see `cell_coordinator_actor`.
caf::result<task_set_plan> apply_set(coordinator_pointer self,
                                     const task_set_request& request);

} // namespace roscell
