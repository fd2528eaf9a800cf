#pragma once

#include "actors/cell/cell_coordinator.hpp"

/// How the CELL COORDINATOR brings nodes in by their names.
namespace roscell {

caf::result<cell_formed> form_cell(coordinator_pointer self,
                                   const cell_formation& request);

} // namespace roscell
