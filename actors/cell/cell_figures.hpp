#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What skills say of themselves, from all nodes of a cell. It is asked for
/// when somebody wants to see it: members at rest send nothing.
namespace roscell {

/// The instances of the cell with what their skills have last said. Of a node
/// that is away, or does not answer in time, figures are left out. Errors:
/// unknown_task.
caf::result<instance_description>
describe_instances_now(coordinator_pointer self, const instance_query& query);

} // namespace roscell
