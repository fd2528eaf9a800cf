#include "tools/roscell/completion/option_values.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <string_view>

namespace roscell::cli {

namespace {

/// What may follow an option or stand as an argument.
struct value_source {
  std::string_view name; ///< Of the option, or of the positional.
  std::string_view action;
};

// `words` takes a list, `files` and `dirs` are paths, `ids` asks the node.
constexpr value_source sources[] = {
    {"--runtime", "words auto docker podman process"},
    {"--log-level", "words trace debug info warn error off"},
    {"--interface", "interfaces"},
    {"--token-file", "files"},
    {"--site-token", "files"},
    {"--socket", "files"},
    {"--config", "files"},
    {"--to", "files"},
    {"--device", "files"},
    {"--data-dir", "dirs"},
    {"--skills", "dirs"},
    {"--man-pages", "dirs"},
    {"--capacity", "capacity"},
    {"--instances", "words refuse terminate reschedule"},
    {"FILE", "files"},
    {"NODE", "ids nodes"},
    {"NAME", "ids nodes"},
    {"CELL", "ids cells"},
    {"TRANSFER", "ids transfers"},
    {"TASK", "ids tasks"},
    {"SUBJECT", "ids tasks"},
    {"TASK|INSTANCE", "ids instances"},
    {"INSTANCE", "ids instances"},
    {"SHELL", "words bash zsh fish"},
    {"COMMAND", "commands"},
    // The shell alone finds these.
    {"ACTOR", "ids actors"},
    {"KIND", "ids kinds"},
    {"--subject", "ids subjects"},
};

} // namespace

std::string action_of(const CLI::Option& option) {
  const auto name =
      option.get_positional() ? option.get_name(true) : names_of(option).back();
  // Commands differ in the forms that they can print: "table|json [table]".
  if (name == "--output") {
    const auto& text = option.get_option_text();
    auto words = text.substr(0, text.find(' '));
    std::replace(words.begin(), words.end(), '|', ' ');
    return "words " + words;
  }
  for (const auto& source : sources)
    if (source.name == name)
      return std::string{source.action};
  return "nothing";
}

std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const auto& name : option.get_snames())
    names.push_back("-" + name);
  for (const auto& name : option.get_lnames())
    names.push_back("--" + name);
  return names;
}

std::vector<std::string> names_of(const CLI::App& command) {
  std::vector<std::string> names{command.get_name()};
  const auto& others = command.get_aliases();
  names.insert(names.end(), others.begin(), others.end());
  return names;
}

} // namespace roscell::cli
