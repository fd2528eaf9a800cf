#pragma once

#include "tools/roscell/client/node_client.hpp"

namespace roscell::cli {

/// The shell at a terminal: reads lines and does what they say until its end.
/// Returns the exit code.
int run_session(const connection_options& connection);

} // namespace roscell::cli
