#pragma once

#include "messages/task_set.hpp"
#include "tools/roscell/tasks/task_apply.hpp"

#include <string>

/// What `roscell apply` and `run` do with a set of tasks: a request that has
/// `for_each`.
namespace roscell::cli {

bool is_set(const json& request);

/// Asks what it means to apply a set; nothing is changed. Throws `refused`.
task_set_plan plan_set(const apply_options& options, const node_client& node,
                       const json& request);

/// Has it done, and waits until nothing is left to be done on any node, unless
/// that is not wanted. Throws `refused`, and command_error where something
/// cannot be done, which the coordinator goes on trying.
/// @return how the set stands then.
task_set_row make_set(const apply_options& options, const node_client& node,
                      const json& request);

/// The same for `run`: what has ended runs once more, and a set that is another
/// one is not changed.
task_set_row run_set(const apply_options& options, const node_client& node,
                     const json& request, bool replace);

/// "it runs on 19 of 20 nodes"; what hinders it on a node stands behind.
std::string set_text(const task_set_row& row);

} // namespace roscell::cli
