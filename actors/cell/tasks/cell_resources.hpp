#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>

/// What the cell has to offer when something is to be placed.
namespace roscell {

/// Asks every active node for its resources, and takes off what is held for
/// instances that the nodes do not know of yet. A node that does not answer in
/// time is left out.
void collect_resources_of_cell(
    coordinator_pointer self,
    const std::function<void(cell_resources&&)>& done);

caf::result<cell_resources> answer_resources(coordinator_pointer self);

} // namespace roscell
