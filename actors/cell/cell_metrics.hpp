#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// What skills say of themselves, from all nodes of a cell. It is asked for
/// when somebody wants to see it: members at rest send nothing.
namespace roscell {

/// The instances of the cell with what their skills have last said. Of a node
/// that is away, or does not answer in time, metrics are left out. What comes
/// after the asker has given up is kept for who asks next. Errors:
/// unknown_task.
caf::result<instance_description>
describe_instances_now(coordinator_pointer self, const instance_query& query);

/// The same for all instances, without telling it.
caf::result<metrics_collected> collect_all_metrics(coordinator_pointer self);

/// Has the nodes of a task asked, and those that write what it reads, so that
/// its streams are judged.
void check_stream_health(coordinator_pointer self, const std::string& task);

/// What is known of the cell, as numbers.
cell_measured measured(const cell_coordinator_state& st);

} // namespace roscell
