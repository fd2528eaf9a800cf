#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace roscell::cli {

/// What may follow an option, or stand as an argument: "words" and a list,
/// "files" and "dirs" for paths, "ids" and a kind of which the node is asked,
/// "interfaces", "capacity", "commands" or "nothing".
std::string action_of(const CLI::Option& option);

/// All names of an option, with their dashes; the long one last.
std::vector<std::string> names_of(const CLI::Option& option);

/// All names of a command, the one that help shows first.
std::vector<std::string> names_of(const CLI::App& command);

} // namespace roscell::cli
