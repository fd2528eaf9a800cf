#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// Changes of stored tasks. Those of one task are written one after the other
/// (`st.pending.lines`), and the tables show a change once the store has
/// persisted it; what the store refuses is retried. A node that gets another
/// name changes all tasks that run on it.
namespace roscell {

/// Writes a change once those before it are done.
void change_task(coordinator_pointer self, const std::string& task,
                 pending_change change);

/// The deadline of a task is that of its record, which was written or taken up.
void follow_deadline(coordinator_pointer self, const std::string& task);

/// Tries the first change of a task again at once, if it waits for that.
void retry_change(coordinator_pointer self, const std::string& task);

/// Retries what the store has not persisted.
void retry_due_changes(coordinator_pointer self);

// The registry knows nodes by their UUIDs, and tasks know them by name: what is
// placed on a node stays with it under another name.

/// A node of the cell has another name from now on. It keeps what it runs.
void rename_node(coordinator_pointer self, const std::string& from,
                 const std::string& to);

/// What is placed on a name that no node of the cell has, and is on the
/// coordination node, was started when that had the name.
void follow_own_name(coordinator_pointer self, const node_registration& own);

} // namespace roscell
