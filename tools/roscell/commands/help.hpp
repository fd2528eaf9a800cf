#pragma once

#include "tools/roscell/exit_code.hpp"

#include <string>

namespace CLI {
class App;
class ParseError;
} // namespace CLI

namespace roscell::cli {

/// `text` for troff: nothing in it is a request, an escape or a hyphenation.
std::string roff(const std::string& text);

/// The manual page roscell(1) of the whole program, from the texts of its help.
std::string program_page(const CLI::App& app);

/// The manual page roscell-COMMAND(1) of one of its commands, with those below
/// it.
std::string command_page(const CLI::App& app, const CLI::App& command);

/// What is wrong with a command line that `app` could not parse, with the word
/// that was probably meant, or else where to read on.
command_error usage_error(const CLI::App& app, const CLI::ParseError& why);

/// That there is no such command.
command_error no_command(const CLI::App& app, const std::string& name);

} // namespace roscell::cli
