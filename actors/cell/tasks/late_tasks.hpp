#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR ends tasks that have run for their `timeout_s`.
/// What still runs of one is ended as by a termination, and has failed; with
/// the last one the task has. `st.deadlines` knows when.
namespace roscell {

/// Has the nodes end what still runs of late tasks. It is tried until all has
/// ended: what is not stop-safe yet is waited for, what moves is ended where it
/// comes up, and what is on a node that is away once that is back.
void end_late_tasks(coordinator_pointer self);

} // namespace roscell
