#pragma once

#include "actors/cell/state/coordinator_state.hpp"

namespace roscell {

/// The CELL COORDINATOR. Messages: messages/inside/coordination.hpp; its tables
/// and what happens to a task are drawn in docs/protocols.md.
cell_coordinator_actor::behavior_type
cell_coordinator(coordinator_pointer self, const actor_context& context,
                 const coordinator_setup& setup);

} // namespace roscell
