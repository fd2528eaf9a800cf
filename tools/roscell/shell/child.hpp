#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/shell/json_collector.hpp"

#include <string>

namespace roscell::cli {

/// What a command reads as its standard input.
enum class child_input {
  shared,  ///< What the shell reads: the terminal.
  nothing, ///< It is at its end.
};

/// Runs a line of the shell in a process of its own, so that Ctrl-C ends that
/// and nothing else, and waits for its end. Returns its exit code; of one that
/// a signal has ended 128 and the number of that, as shells do.
int run_child(const connection_options& connection, const std::string& line,
              child_input input);

/// Sends a request as `roscell request -` would, unless something is wrong with
/// it, which is told. Returns the exit code.
int send_by_child(const connection_options& connection,
                  const json_collector& request);

} // namespace roscell::cli
