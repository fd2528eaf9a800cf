#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR brings nodes in by their names.
namespace roscell {

caf::result<cell_formed> form_cell(coordinator_pointer self,
                                   const cell_formation& request);

} // namespace roscell
