#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// How the CELL COORDINATOR answers who wants a task to run: it takes the
/// placement lock, or hears how the task stands. The table is in
/// docs/protocols.md, "A task".
namespace roscell {

/// Errors: task_exists (another body), conflict (it is being terminated, too
/// many wait, or something of its name may still run), and those of healing.
caf::result<task_claimed> claim_placement_lock(coordinator_pointer self,
                                               const claim_task& request);

/// How a task stands that is known.
task_claimed known_reply(const cell_coordinator_state& st,
                         const std::string& task);

} // namespace roscell
