#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR brings what runs nearer to the optimum of the
/// paper's equations (1) to (4): one move after the other, each healthy before
/// the next.
namespace roscell {

caf::result<cell_rebalanced> rebalance_cell(coordinator_pointer self,
                                            const cell_rebalance& request);

/// A moved instance that breaks before it has settled ends the moves.
void watch_moved(coordinator_pointer self, const instance_row& row);

/// Goes on to the next move once the last one has settled.
void settle_due_move(coordinator_pointer self);

} // namespace roscell
