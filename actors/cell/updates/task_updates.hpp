#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR changes a task that runs: what has not changed goes
/// on, what has is replaced wave by wave, each running well before the next,
/// and where one does not, all of it is put back. The update table
/// (`st.updates`) knows how far each is.
///
/// Messages: task_update and task_revisions_query. Errors: unknown_task,
/// conflict (the task is being deployed, ended, moved or updated, or a node
/// that has to end something is away), no_feasible_allocation, those of reading
/// a request, and those of the store.
namespace roscell {

/// Replies when it is known what is to be done, and the first of it is written
/// down; how it goes on is told by the task's row and events.
caf::result<task_update_plan> update_task(coordinator_pointer self,
                                          const task_update& request);

caf::result<task_revisions> list_revisions(coordinator_pointer self,
                                           const task_revisions_query& query);

// Whether what an update has started runs well, until the update is over: all
// of it is undone where it does not.

/// A node has told of an instance. One that an update has started and that
/// breaks undoes the update.
void watch_updated(coordinator_pointer self, const instance_row& row);

/// Goes on with the updates whose new instances have run well for long enough.
///
/// In between one may have broken without a word, where its node was lost: that
/// undoes the update, too.
void settle_due_updates(coordinator_pointer self);

} // namespace roscell
