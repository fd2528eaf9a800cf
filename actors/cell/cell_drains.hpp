#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>
#include <vector>

/// How the CELL COORDINATOR empties nodes: they take nothing new, and what they
/// run moves to others as these have room.
namespace roscell {

/// Takes up what an earlier run of the coordinator has stored.
void restore_drains(coordinator_pointer self);

caf::result<node_drained> drain_node(coordinator_pointer self,
                                     const node_drain& request);
caf::result<node_undrained> undrain_node(coordinator_pointer self,
                                         const node_undrain& request);

/// Moves what is due.
void go_on_draining(coordinator_pointer self);

} // namespace roscell
