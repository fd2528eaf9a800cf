#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstddef>
#include <functional>
#include <string>

/// Questions that the CELL COORDINATOR passes on to its members: logs of
/// instances, and metrics of skills. Members at rest send neither by
/// themselves. Nothing is owned here but `open_questions`, which counts the
/// answers.
///
/// Messages: log_query, kept_logs_query and instance_query. Errors:
/// unknown_task and unreachable; of many nodes those that do not answer are
/// left out.
namespace roscell {

// Logs of instances of a cell, on whichever node they are.

/// A part of the log of an instance, or of the newest that a node has kept of
/// it. Errors: unknown_task, unreachable.
caf::result<log_excerpt> fetch_log(coordinator_pointer self,
                                   const log_query& query);

/// The kept logs of all nodes, by their ends. Nodes that are away, silent or of
/// an earlier version are named instead.
caf::result<kept_logs> collect_kept_logs(coordinator_pointer self,
                                         const kept_logs_query& query);

// Metrics of skills, from all nodes of the cell.

/// The instances of the cell with what their skills have last said. Of a node
/// that is away, or does not answer in time, metrics are left out. What comes
/// after the asker has given up is kept for who asks next. Errors:
/// unknown_task.
caf::result<instance_description> instances_now(coordinator_pointer self,
                                                const instance_query& query);

/// The same for all instances; the answer says only that they are known now.
caf::result<metrics_collected> collect_all_metrics(coordinator_pointer self);

/// Has the nodes of a task asked, and those that write what it reads, so that
/// its streams are judged.
void check_stream_health(coordinator_pointer self, const std::string& task);

/// What is known of the cell, as numbers.
cell_measured measured(const cell_coordinator_state& st);

/// A question to several nodes, until all have answered. Whoever asks counts as
/// one of them until he has asked all.
struct open_questions {
  size_t open = 1;
  std::function<void()> on_all; ///< It must not hold this itself.

  void finish_one() {
    if (--open == 0)
      on_all();
  }
};

} // namespace roscell
