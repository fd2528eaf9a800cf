#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// Logs of instances of a cell, on whichever node they are.
namespace roscell {

/// A part of the log of an instance, or of the newest that a node has kept of
/// it. Errors: unknown_task, unreachable.
caf::result<log_excerpt> fetch_log(coordinator_pointer self,
                                   const log_query& query);

/// The kept logs of all nodes, by their ends. Nodes that are away, silent or of
/// an earlier version are named instead.
caf::result<kept_logs> collect_kept_logs(coordinator_pointer self,
                                         const kept_logs_query& query);

} // namespace roscell
