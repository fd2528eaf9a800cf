#pragma once

#include "tools/roscell/client/node_client.hpp"

#include <string>

namespace roscell::cli {

/// Prints what has happened to a task, in order; as JSON if so wanted.
void print_history(const node_client& node, const std::string& task,
                   bool as_json);

} // namespace roscell::cli
