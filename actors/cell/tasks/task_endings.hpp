#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR ends tasks: on request, when a deployment fails,
/// and when too many are settled. How steps end is in step_ends.hpp.
namespace roscell {

caf::error terminated_meanwhile(const std::string& task);

caf::result<task_terminated> terminate_task(coordinator_pointer self,
                                            const task_termination& request);

/// Undoes a deployment, on these nodes too. Calls `done` once all of it is
/// gone, or as soon as it is known what has to be stop-safe before.
///
/// Meanwhile the task may be terminated, by force too, and its nodes be lost;
/// whoever waits for it is answered by `end_waiting`, and nowhere else.
void roll_back(coordinator_pointer self, const std::string& task,
               const std::string& reason,
               const std::vector<std::string>& also_on,
               const std::function<void()>& done);

/// The pipeline of a task is gone: a termination that waited for it goes on,
/// and what it was deploying is rolled back.
void on_owner_gone(coordinator_pointer self, const std::string& task);

/// Ends a task that has no pipeline and that nobody waits for.
void end_settled(coordinator_pointer self, const std::string& task);

/// Calls `done` once no task is being deployed to the node: at once if none is.
/// Each deployment ends, at the latest with its time limit.
void after_deployments_on(coordinator_pointer self, const std::string& node,
                          std::function<void()> done);

/// To be called when a task is no longer being deployed.
void settle_awaited_deployments(coordinator_pointer self);

} // namespace roscell
