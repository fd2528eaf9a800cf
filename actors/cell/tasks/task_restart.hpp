#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR starts again what has ended, or what somebody wants
/// to begin anew.
namespace roscell {

/// The steps of a task that have ended otherwise than with 0, and those whose
/// node has gone from the cell.
std::vector<std::string> steps_to_heal(const cell_coordinator_state& st,
                                       const std::string& task);

/// Starts these anew, where they fit. All or nothing.
/// @param done called once: when they run, or cannot.
void heal_task(coordinator_pointer self, const std::string& task,
               const completion_handler& done);

/// Starts these instances of a task, which have ended, where they fit. All or
/// nothing, as above; what is gone meanwhile is none.
/// @param done called once: when they run, or cannot.
void start_ended(coordinator_pointer self, const std::string& task,
                 const std::vector<std::string>& instances,
                 const completion_handler& done);

/// Ends instances of a task and starts them again on their nodes; what had
/// ended, also with 0, where it fits.
caf::result<task_restarted> restart_task(coordinator_pointer self,
                                         const task_restart& request);

} // namespace roscell
