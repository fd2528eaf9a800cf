#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does about task requests: claim, intent, and the
/// word that all steps run. How tasks end is in task_endings.hpp.
namespace roscell {

/// Takes up the tasks that an earlier run of the coordinator has stored.
void restore_tasks(coordinator_pointer self);

caf::result<task_claimed> claim_task_turn(coordinator_pointer self,
                                          const claim_task& request);
caf::result<intent_recorded> hold_placement(coordinator_pointer self,
                                            const record_intent& intent);
caf::result<task_accepted> accept_task(coordinator_pointer self,
                                       const record_running& fact);
caf::result<task_rolled_back> undo_deployment(coordinator_pointer self,
                                              const record_failure& fact);

/// A pipeline has ended: what it was deploying is rolled back.
void on_pipeline_down(coordinator_pointer self, const caf::actor_addr& gone);

/// Adds to a spec what the cell adds to every instance.
void complete_spec(const cell_coordinator_state& st, instance_spec& spec);

} // namespace roscell
