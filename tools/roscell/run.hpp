#pragma once

#include "tools/roscell/commands.hpp"

#include <functional>
#include <string>
#include <vector>

namespace roscell::cli {

/// The whole program: parses the command line and does what it says. Returns
/// the exit code (tools/roscell/exit_code.hpp).
int run(int argc, char** argv);

/// Adds commands to the command line.
using command_set = std::function<void(CLI::App& app, action& chosen)>;

/// The same for words that stand behind the program's name, with these
/// commands in place of its own.
int run(const command_set& commands, std::vector<std::string> words);

} // namespace roscell::cli
