#pragma once

#include "tools/roscell/exit_code.hpp"

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace roscell::cli {

/// What is wrong with a command line that `app` could not parse, with the word
/// that was probably meant, or else where to read on.
command_error usage_error(const CLI::App& app, const CLI::ParseError& why);

/// That there is no such command.
command_error no_command(const CLI::App& app, const std::string& name);

} // namespace roscell::cli
