#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The life of a task up to the moment when all its steps run, and again after
/// some have ended: the claim of its name, the intent to deploy it, preemption
/// for it, healing and restart. Tasks stand in `st.tasks`, their instances in
/// `st.deployments`. How a task ends is in task_endings.hpp.
///
/// Messages: claim_task, record_intent, record_running, record_failure,
/// preempt_instances and task_restart. Errors: task_exists, conflict,
/// unknown_task, no_feasible_allocation, and those of the store and of nodes.
namespace roscell {

/// Takes up the tasks that an earlier run of the coordinator has stored.
void restore_tasks(coordinator_pointer self);

/// Those whose deployment or end was not over have no record any more, but for
/// where they may run on.
void drop_unfinished_tasks(coordinator_pointer self);

caf::result<intent_recorded> hold_placement(coordinator_pointer self,
                                            const record_intent& intent);
caf::result<task_accepted> accept_task(coordinator_pointer self,
                                       const record_running& event);
caf::result<task_rolled_back> undo_deployment(coordinator_pointer self,
                                              const record_failure& event);

/// A pipeline has ended: what it was deploying is rolled back.
void on_pipeline_down(coordinator_pointer self, const caf::actor_addr& gone);

// Who wants a task to run gets the placement lock, or the task's status. The
// table is in docs/protocols.md, "A task".

/// Errors: task_exists (another body), conflict (it is being terminated, too
/// many wait, or something of its name may still run), and those of healing.
caf::result<task_claimed> claim_placement_lock(coordinator_pointer self,
                                               const claim_task& request);

/// The status of a task that is known.
task_claimed known_reply(const cell_coordinator_state& st,
                         const std::string& task);

// Preemption for a task of higher priority: what is preempted is ended, once it
// is stop-safe, and started again where there is still room.

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

// Healing and restart: what has ended is started again, or what an operator
// wants to begin anew.

/// What keeps a task's instances from being replaced or started again now;
/// null: nothing.
std::optional<failure> why_busy(const cell_coordinator_state& st,
                                const std::string& task);

/// The same, whether or not parameters of it are being changed.
std::optional<failure> why_unsettled(const cell_coordinator_state& st,
                                     const std::string& task);

/// The steps of a task that have ended otherwise than with 0, and those whose
/// node has gone from the cell.
std::vector<std::string> steps_to_heal(const cell_coordinator_state& st,
                                       const std::string& task);

/// Starts these anew, where they fit. All or nothing.
/// @param done called once: when they run, or cannot.
void heal_task(coordinator_pointer self, const std::string& task,
               const completion_handler& done);

/// The same, but for an update: on the nodes where they were, or, where they do
/// not fit there, where they do.
void start_where_they_were(coordinator_pointer self, const std::string& task,
                           const std::vector<std::string>& instances,
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
