#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/shell/builtins.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// All that can be said in the shell: its own words, and every command of
/// `roscell`.
/// @param shell null where nobody types.
void set_up_vocabulary(CLI::App& app, action& chosen, live_shell* shell);

/// Whether the shell does this itself; all else has a process of its own.
bool changes_shell(const std::vector<std::string>& words);

/// Does what a line says, in this process, for the node of `connection` unless
/// the line names another. Returns the exit code.
int run_line(const std::string& line, const connection_options& connection,
             live_shell* shell);

} // namespace roscell::cli
