#include "tools/roscell/commands/completion.hpp"

#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

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

/// The case of one command: its options, then what follows those of them that
/// take a value, then its arguments.
std::string command_case(const CLI::App& command) {
  std::vector<std::string> flags;
  std::vector<std::string> with_value;
  std::string values;
  std::string arguments;
  for (const auto* option : command.get_options()) {
    if (option->get_positional()) {
      arguments += " '" + action_of(*option) + "'";
      continue;
    }
    const auto names = names_of(*option);
    flags.insert(flags.end(), names.begin(), names.end());
    if (option->get_items_expected_max() == 0)
      continue;
    with_value.insert(with_value.end(), names.begin(), names.end());
    values += "        " + joined(names, "|") + ") _roscell_"
              + action_of(*option) + "; return ;;\n";
  }
  std::vector<std::string> below;
  for (const auto* x :
       command.get_subcommands([](const auto*) { return true; }))
    below.push_back(x->get_name());
  if (!below.empty())
    arguments = " 'words " + joined(below, " ") + "'";
  auto text = "    " + joined(names_of(command), "|") + ")\n";
  if (!values.empty())
    text += "      case $prev in\n" + values + "      esac\n";
  if (arguments.empty())
    arguments = " nothing";
  return text + "      options='" + joined(flags, " ")
         + "'\n      with_value=' " + joined(with_value, " ")
         + " '\n      arguments=(" + arguments.substr(1) + ") ;;\n";
}

constexpr auto head = R"bash(# bash completion for roscell; to use it now:
#   source <(roscell completion bash)
# and for good:
#   roscell completion bash > /etc/bash_completion.d/roscell

_roscell_words() {
  COMPREPLY=($(compgen -W "$*" -- "$cur"))
}

_roscell_capacity() {
  compopt -o nospace
  _roscell_words cpu= memory_mib= disk_mib=
}

_roscell_files() {
  compopt -o filenames
  COMPREPLY=($(compgen -f -- "$cur"))
}

_roscell_dirs() {
  compopt -o filenames
  COMPREPLY=($(compgen -d -- "$cur"))
}

_roscell_commands() {
  _roscell_words "$_roscell_commands"
}

_roscell_nothing() {
  COMPREPLY=()
}

_roscell_interfaces() {
  _roscell_words "$(ls /sys/class/net 2>/dev/null)"
}

# Ids are the first column of a table; what the node refuses is not shown, and
# one that does not answer at once is not waited for.
# compgen expands its words like the shell does, so that no other text of a
# node may come to it.
_roscell_ids() {
  # COMP_WORDS is split at colons, and addresses have some.
  local to=() line=($COMP_LINE) i
  for ((i = 1; i + 1 < ${#line[@]}; i++)); do
    case ${line[i]} in
      --to|--token-file) to+=("${line[i]}" "${line[i + 1]}") ;;
    esac
  done
  _roscell_words "$(ROSCELL_TIMEOUT=600ms roscell "$1" "${to[@]}" 2>/dev/null |
    awk 'NR > 1 && $1 ~ /^[A-Za-z0-9._-]+$/ { print $1 }')"
}

# The arguments before the word at the cursor are counted; the last one can be
# repeated.
_roscell_argument() {
  local line i place=0 last
  read -ra line <<< "$COMP_LINE"
  last=${#line[@]}
  [[ $COMP_LINE == *' ' ]] || ((last--))
  for ((i = 2; i < last; i++)); do
    case ${line[i]} in
      -*) [[ $with_value != *" ${line[i]} "* ]] || ((++i)) ;;
      *) ((++place)) ;;
    esac
  done
  ((place < ${#arguments[@]})) || place=$((${#arguments[@]} - 1))
  _roscell_${arguments[place]}
}

_roscell() {
  local cur=${COMP_WORDS[COMP_CWORD]} prev=${COMP_WORDS[COMP_CWORD - 1]}
  local options with_value arguments
  if ((COMP_CWORD == 1)); then
    _roscell_words "$_roscell_commands"
    return
  fi
  case ${COMP_WORDS[1]} in
)bash";

constexpr auto tail = R"bash(    *) return ;;
  esac
  if [[ $cur == -* ]]; then
    _roscell_words "$options"
  else
    _roscell_argument
  fi
}

complete -F _roscell roscell
)bash";

std::string completion_of(const CLI::App& app, const std::string& shell) {
  if (shell == "zsh")
    return zsh_completion(app);
  return shell == "fish" ? fish_completion(app) : bash_completion(app);
}

} // namespace

std::string value_name(const CLI::Option& option) {
  return option.get_positional() ? option.get_name(true)
                                 : names_of(option).back();
}

std::string action_of(const CLI::Option& option) {
  const auto name = value_name(option);
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

std::string bash_completion(const CLI::App& app) {
  std::vector<std::string> commands;
  std::string cases;
  for (const auto* command : app.get_subcommands({})) {
    commands.push_back(command->get_name());
    cases += command_case(*command);
  }
  for (const auto* option : app.get_options())
    commands.push_back(names_of(*option).back());
  return "_roscell_commands='" + joined(commands, " ") + "'\n\n" + head + cases
         + tail;
}

void add_completion_command(CLI::App& app, action& chosen) {
  auto shell = std::make_shared<std::string>();
  auto* command = app.add_subcommand("completion",
                                     "Print the completion script of a shell.");
  command->footer("Examples:\n  source <(roscell completion bash)\n"
                  "  roscell completion bash > "
                  "/etc/bash_completion.d/roscell\n"
                  "  roscell completion zsh > "
                  "/usr/local/share/zsh/site-functions/_roscell\n"
                  "  roscell completion fish > "
                  "~/.config/fish/completions/roscell.fish");
  command->add_option("SHELL", *shell, "bash, zsh or fish")
      ->required()
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->option_text(" ");
  command->callback([&app, &chosen, shell] {
    chosen = [&app, shell] {
      print(completion_of(app, *shell));
      return exit_done;
    };
  });
}

} // namespace roscell::cli
