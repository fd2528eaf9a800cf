#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/instance.hpp"

#include <caf/expected.hpp>

#include <vector>

/// How the CELL COORDINATOR shows tasks and instances.
namespace roscell {

std::vector<task_row> describe_all_tasks(const cell_coordinator_state& st);

/// Errors: unknown_task.
caf::result<task_description> describe_tasks(const cell_coordinator_state& st,
                                             const task_query& query);

/// Errors: unknown_task.
caf::expected<instance_description>
describe_instances(const cell_coordinator_state& st,
                   const instance_query& query);

/// How a task that is known stands: its state, and what of it does not run.
task_accepted status_reply(const cell_coordinator_state& st,
                           const std::string& task);

/// The state of a task as its instances are now.
task_state state_of_task(const cell_coordinator_state& st,
                         const std::string& task, const task_entry& entry);

/// How many tasks are in each state.
std::vector<task_count> count_tasks(const cell_coordinator_state& st);

/// The registry's rows, each with what its node has told of instances.
std::vector<registry_row> describe_nodes(const cell_coordinator_state& st);

/// Whether that node of the cell can be asked now.
bool is_present(const cell_coordinator_state& st, const std::string& node);

caf::error unknown_thing(const std::string& what, const std::string& id);

/// Puts the steps of one task into the order in which data flow through them:
/// each behind all that it gets something from, steps of which this says
/// nothing as they were. Where data flow in a circle, what leads back does not
/// count. Pictures of a task are drawn in this order.
void sort_by_flow(std::vector<instance_row>& steps);

} // namespace roscell
