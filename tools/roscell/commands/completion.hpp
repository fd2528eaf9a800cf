#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace roscell::cli {

/// Each gives the script with which a shell completes the commands and options
/// of `app`, its files and directories, and the ids of nodes, tasks and
/// instances, for which it asks the node quietly.
std::string bash_completion(const CLI::App& app);
std::string zsh_completion(const CLI::App& app);
std::string fish_completion(const CLI::App& app);

/// The option's long name, or that of an argument.
std::string value_name(const CLI::Option& option);

/// What may follow an option, or stand as an argument: a function of each
/// script without its prefix, and the function's arguments. `words` takes a
/// list, `files` and `dirs` are paths, `ids` asks the node.
std::string action_of(const CLI::Option& option);

/// All names of an option, with their dashes; the long one last.
std::vector<std::string> names_of(const CLI::Option& option);

/// All names of a command, the one that help shows first.
std::vector<std::string> names_of(const CLI::App& command);

} // namespace roscell::cli
