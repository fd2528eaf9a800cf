#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>
#include <vector>

namespace roscell {

/// Moves what these tasks run on a node that is about to leave to the active
/// members, where the scheduler places it. There is room for all of it, or
/// nothing happens. First all move whose new instances run before the old ones
/// end, all or nothing; then, one by one, those that have to be stop-safe. If
/// one does not come up what has not moved yet stays. The tasks run.
/// @param done called once: when all has moved, or something cannot, with the
/// first problem then.
void move_tasks(coordinator_pointer self, const std::string& node,
                const std::vector<std::string>& tasks,
                const completion_handler& done);

/// Moves one instance to that node, in the same way. With `force` nothing is
/// waited for to be stop-safe.
/// @param done called once, as above.
void move_instance(coordinator_pointer self, const std::string& instance,
                   const std::string& to, bool force,
                   const completion_handler& done);

// How the CELL COORDINATOR brings what runs nearer to the optimum of the
// paper's equations (1) to (4): one move after the other, each healthy before
// the next.

caf::result<cell_rebalanced> rebalance_cell(coordinator_pointer self,
                                            const cell_rebalance& request);

/// A moved instance that breaks before it has settled ends the moves.
void watch_moved(coordinator_pointer self, const instance_row& row);

/// Goes on to the next move once the last one has settled.
void settle_due_move(coordinator_pointer self);

} // namespace roscell
