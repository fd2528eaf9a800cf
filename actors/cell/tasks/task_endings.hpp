#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR ends tasks: on request, when a deployment fails,
/// and when too many are settled.
namespace roscell {

caf::error terminated_meanwhile(const std::string& task);

caf::result<task_terminated> terminate_task(coordinator_pointer self,
                                            const task_termination& request);

/// Undoes a deployment, on these nodes too, then calls `done`.
void roll_back(coordinator_pointer self, const std::string& task,
               const std::string& reason,
               const std::vector<std::string>& also_on,
               const std::function<void()>& done);

/// The pipeline of a task is gone: a termination that waited for it goes on,
/// and what it was deploying is rolled back.
void on_owner_gone(coordinator_pointer self, const std::string& task);

/// Takes what the nodes have told of a task's ends into its record.
void record_ends(coordinator_pointer self, const std::string& task);

/// Writes down that an instance whose end is ignored so far was ended for that
/// reason, whatever its exit code, and heeds its ends again. Then `done` is
/// called: with a failure if the task is gone.
void record_forced_end(coordinator_pointer self, const std::string& task,
                       const std::string& instance, const std::string& reason,
                       const std::function<void(const failure*)>& done);

/// Tells what has become of a task whose steps have all ended, and forgets the
/// oldest of these. Nothing happens while a step of it runs.
void settle_ended(coordinator_pointer self, const std::string& task);

/// Calls `done` once no task is being deployed to the node: at once if none is.
/// Each deployment ends, at the latest with its time limit.
void after_deployments_on(coordinator_pointer self, const std::string& node,
                          std::function<void()> done);

/// To be called when a task is no longer being deployed.
void settle_awaited_deployments(coordinator_pointer self);

} // namespace roscell
