#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR preempts for a task of higher priority: what goes
/// is ended, once it is stop-safe, and started again where there is still room.
namespace roscell {

/// Ends these instances, whose room a task that is being deployed holds
/// already, and replies once they are gone.
caf::result<instances_preempted>
preempt_for_task(coordinator_pointer self, const preempt_instances& request);

/// Takes up what an earlier run of the coordinator has told to end.
void restore_orders(coordinator_pointer self);

/// Starts again what has ended by order, where nobody needs its room any more,
/// those of the highest priority first. What does not fit stays ended, as
/// failed, until its task is asked for again.
///
/// Meanwhile it may be started by somebody else, or its task be terminated.
void start_due_again(coordinator_pointer self);

} // namespace roscell
