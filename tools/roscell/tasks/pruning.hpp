#pragma once

#include "messages/task_update.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <string>
#include <vector>

/// What `roscell apply --prune` ends.
namespace roscell::cli {

/// Tasks and sets of the cell that have a label and are in no file; of sets
/// only the name is told. Throws command_error for what is no label.
/// @param label "NAME=VALUE"; empty: nothing is ended.
std::vector<task_row> to_be_pruned(const std::string& label,
                                   const node_client& node,
                                   const std::vector<task_file>& files);

/// That, as a change of each of its steps.
task_update_plan plan_of_pruned(const task_row& x);

} // namespace roscell::cli
