#pragma once

#include "messages/instance.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <string>

namespace roscell::cli {

/// The instance that a word means: its id or the beginning of that,
/// "TASK/STEP", or a task; of several the only one that has not ended. Throws
/// command_error that says what was probably meant, or which ones there are.
instance_row find_instance(const node_client& node, const std::string& word);

} // namespace roscell::cli
