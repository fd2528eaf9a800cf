#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// How what changes of a task gets on disk: one change of a task after the
/// other, and the tables show it when the store has kept it.
namespace roscell {

/// Writes a change once those before it are done.
void change_task(coordinator_pointer self, const std::string& task,
                 pending_change change);

/// Tries the first change of a task again at once, if it waits for that.
void retry_change(coordinator_pointer self, const std::string& task);

/// Tries again what the store did not keep.
void retry_due_changes(coordinator_pointer self);

// How what is placed on a node stays with it under another name: the CELL
// COORDINATOR knows nodes by their UUIDs, and its tasks know them by name.

/// A node of the cell has another name from now on. It keeps what it runs.
void rename_node(coordinator_pointer self, const std::string& from,
                 const std::string& to);

/// What is placed on a name that no node of the cell has, and is on the
/// coordination node, was started when that had the name.
void follow_own_name(coordinator_pointer self, const node_registration& own);

} // namespace roscell
