#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does about tasks that are deployed: the intent,
/// and the word that all steps run. How they are claimed is in task_claims.hpp,
/// how they end in task_endings.hpp.
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

} // namespace roscell
