#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>

/// What the CELL COORDINATOR makes of the ends of steps: they are written down,
/// and so is what becomes of their task.
namespace roscell {

/// Takes what the nodes have told of a task's ends into its record.
void record_ends(coordinator_pointer self, const std::string& task);

/// Writes down that an instance whose end is ignored so far was ended for that
/// reason, whatever its exit code, and heeds its ends again.
/// @param done called once: when that is written, or the task is gone.
void record_forced_end(coordinator_pointer self, const std::string& task,
                       const std::string& instance, const std::string& reason,
                       const completion_handler& done);

/// Tells what has become of a task whose steps have all ended, and forgets the
/// oldest of these. Nothing happens while a step of it runs.
void settle_ended(coordinator_pointer self, const std::string& task);

} // namespace roscell
