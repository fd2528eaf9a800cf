#pragma once

#include <string>

namespace CLI {
class App;
} // namespace CLI

namespace roscell::cli {

/// `text` for troff: nothing in it is a request, an escape or a hyphenation.
std::string roff(const std::string& text);

/// The manual page roscell(1) of the whole program, from the texts of its help.
std::string program_page(const CLI::App& app);

/// The manual page roscell-COMMAND(1) of one of its commands, with those below
/// it.
std::string command_page(const CLI::App& app, const CLI::App& command);

} // namespace roscell::cli
