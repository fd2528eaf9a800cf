#pragma once

#include "actors/cell/cell_coordinator.hpp"

#include <functional>
#include <string>

/// What the CELL COORDINATOR does about tasks.
namespace roscell {

/// Takes up the tasks that an earlier run of the coordinator has stored.
void restore_tasks(coordinator_pointer self);

caf::result<task_claimed> claim_turn(coordinator_pointer self,
                                     const claim_task& request);
caf::result<agents_found> answer_agents(coordinator_pointer self,
                                        const find_agents& asked);
caf::result<intent_recorded> hold_resources(coordinator_pointer self,
                                            const record_intent& intent);
caf::result<outcome_recorded> settle_task(coordinator_pointer self,
                                          const record_outcome& outcome);
caf::result<task_terminated> terminate(coordinator_pointer self,
                                       const task_termination& request);

/// A pipeline has ended: what it was deploying is rolled back.
void on_pipeline_down(coordinator_pointer self, const caf::actor_addr& gone);

/// Calls `done` once no task is being deployed to the node: at once if none is.
/// Each deployment ends, at the latest with its time limit.
void after_deployments_on(coordinator_pointer self, const std::string& node,
                          std::function<void()> done);

/// Adds to a spec what the cell adds to every instance.
void complete_spec(const cell_coordinator_state& st, instance_spec& spec);

task_row describe_task(coordinator_pointer self, const task_record& record);

} // namespace roscell
