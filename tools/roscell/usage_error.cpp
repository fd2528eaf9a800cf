#include "tools/roscell/usage_error.hpp"

#include "schemas/text_excerpt.hpp"

#include <CLI/CLI.hpp>

#include <string_view>
#include <vector>

namespace roscell::cli {

namespace {

/// Where it is told how a command is used.
std::string help_of(const CLI::App& command) {
  return command.get_parent() == nullptr
             ? "`roscell --help` lists the commands"
             : "`roscell " + command.get_name()
                   + " --help` shows how it is used";
}

std::vector<std::string> options_of(const CLI::App& command) {
  std::vector<std::string> result;
  for (const auto* option : command.get_options()) {
    for (const auto& name : option->get_lnames())
      result.push_back("--" + name);
    for (const auto& name : option->get_snames())
      result.push_back("-" + name);
  }
  return result;
}

std::string_view closest(std::string_view typed,
                         const std::vector<std::string>& words) {
  return closest_word(typed, {words.begin(), words.end()});
}

command_error no_option(const CLI::App& command, const std::string& word) {
  const auto name = word.substr(0, word.find('='));
  const auto words = options_of(command);
  const auto meant = closest(name, words);
  return {exit_usage,
          (command.get_parent() == nullptr
               ? "there is no option "
               : "`roscell " + command.get_name() + "` has no option ")
              + name,
          meant.empty() ? help_of(command)
                        : "did you mean " + std::string{meant} + "?"};
}

/// A word that fits nowhere.
command_error misplaced(const CLI::App& app, const CLI::App& command,
                        const std::string& word) {
  if (word.size() > 1 && word.front() == '-')
    return no_option(command, word);
  if (&command == &app)
    return no_command(app, word);
  return {exit_usage,
          "'" + word + "' is one argument too many for `roscell "
              + command.get_name() + "`",
          help_of(command)};
}

} // namespace

command_error no_command(const CLI::App& app, const std::string& name) {
  std::vector<std::string> names;
  for (const auto* command : app.get_subcommands({}))
    names.push_back(command->get_name());
  const auto meant = closest(name, names);
  return {exit_usage, "there is no command '" + name + "'",
          meant.empty() ? help_of(app)
                        : "did you mean `roscell " + std::string{meant} + "`?"};
}

command_error usage_error(const CLI::App& app, const CLI::ParseError& why) {
  const auto chosen = app.get_subcommands();
  const auto& command = chosen.empty() ? app : *chosen.back();
  // What is left over may be why something else is missing.
  if (const auto rest = app.remaining(true); !rest.empty())
    return misplaced(app, command, rest.front());
  if (chosen.empty())
    return {exit_usage, "a command is missing", help_of(app)};
  return {exit_usage, why.what(), help_of(command)};
}

} // namespace roscell::cli
