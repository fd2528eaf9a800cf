#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR starts again what has ended, or what somebody wants
/// to begin anew.
namespace roscell {

/// The steps of a task that have ended otherwise than with 0.
std::vector<std::string> failed_steps(const cell_coordinator_state& st,
                                      const std::string& task);

/// Starts what of a task has ended otherwise than with 0, where it fits. All or
/// nothing; `done` gets the failure, or null once it runs.
void heal_task(coordinator_pointer self, const std::string& task,
               const std::function<void(const failure*)>& done);

/// Starts these instances of a task, which have ended, where they fit. All or
/// nothing, as above; what is gone meanwhile is none.
void start_ended(coordinator_pointer self, const std::string& task,
                 const std::vector<std::string>& instances,
                 const std::function<void(const failure*)>& done);

/// Ends instances of a task and starts them again on their nodes; what had
/// ended, also with 0, where it fits.
caf::result<task_restarted> restart_task(coordinator_pointer self,
                                         const task_restart& request);

} // namespace roscell
