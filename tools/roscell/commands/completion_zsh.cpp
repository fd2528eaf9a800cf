#include "tools/roscell/commands/completion.hpp"

#include <CLI/CLI.hpp>

namespace roscell::cli {

namespace {

/// `text` between single quotes, where `special` characters have a meaning.
std::string zsh_text(const std::string& text, std::string_view special = "") {
  std::string result;
  for (const char x : text) {
    if (x == '\'')
      result += "'\\'";
    else if (special.find(x) != std::string_view::npos)
      result += '\\';
    result += x;
  }
  return result;
}

/// How zsh zsh_action what `action_of` says. After a blank the arguments of a
/// function stay what they are.
std::string zsh_action(const CLI::Option& option) {
  return ":" + value_name(option) + ": _roscell_" + action_of(option);
}

/// One line for each name of an option.
std::string zsh_options(const CLI::Option& option) {
  std::string result;
  const auto names = names_of(option);
  const bool takes_value = option.get_items_expected_max() != 0;
  for (const auto& name : names)
    result += "        '*" + name + "["
              + zsh_text(option.get_description(), ":[]\\") + "]"
              + (takes_value ? zsh_action(option) : "") + "' \\\n";
  return result;
}

/// The case of one command. Its last argument may be repeated.
std::string zsh_case(const CLI::App& command) {
  std::string options;
  std::vector<std::string> arguments;
  for (const auto* option : command.get_options())
    if (option->get_positional())
      arguments.push_back(zsh_action(*option));
    else
      options += zsh_options(*option);
  auto text = "    " + joined(names_of(command), "|")
              + ")\n      _arguments \\\n" + options;
  for (size_t i = 0; i < arguments.size(); ++i)
    text += "        '"
            + (i + 1 < arguments.size() ? std::to_string(i + 1) : "*")
            + arguments[i] + "' \\\n";
  return text + "        && return 0\n      ;;\n";
}

constexpr auto zsh_head = R"zsh(#compdef roscell
# zsh completion for roscell; put it into a directory of $fpath:
#   roscell completion zsh > /usr/local/share/zsh/site-functions/_roscell

_roscell_words() {
  compadd -- "$@"
}

_roscell_capacity() {
  compadd -S '' -- cpu= memory_mib= disk_mib=
}

_roscell_files() {
  _files
}

_roscell_dirs() {
  _files -/
}

_roscell_nothing() {
  return 1
}

_roscell_interfaces() {
  compadd -- /sys/class/net/*(N:t)
}

_roscell_commands() {
  _describe command _roscell_all
}

# Ids are the first column of a table; what the node refuses is not shown, and
# one that does not answer at once is not waited for.
_roscell_ids() {
  local -a to
  local kind=$1 i
  for ((i = 1; i < CURRENT - 1; i++)); do
    case $words[i] in
      --to|--token-file) to+=("$words[i]" "$words[i+1]") ;;
    esac
  done
  compadd -- ${(f)"$(ROSCELL_TIMEOUT=600ms roscell $kind $to 2>/dev/null |
    awk 'NR > 1 && $1 ~ /^[A-Za-z0-9._-]+$/ { print $1 }')"}
}

)zsh";

constexpr auto zsh_cases = R"zsh(
_roscell() {
  if ((CURRENT == 2)); then
    _roscell_commands
    return
  fi
  shift words
  ((CURRENT--))
  case $words[1] in
)zsh";

constexpr auto zsh_tail = R"zsh(  esac
}

# The file is loaded as a function, or read by `source`.
if [[ $ZSH_EVAL_CONTEXT == *(shfunc|loadautofunc) ]]; then
  _roscell "$@"
else
  compdef _roscell roscell
fi
)zsh";

} // namespace

std::string zsh_completion(const CLI::App& app) {
  std::string commands;
  std::string cases;
  for (const auto* command : app.get_subcommands({})) {
    commands += "  '" + zsh_text(command->get_name()) + ":"
                + zsh_text(command->get_description()) + "'\n";
    cases += zsh_case(*command);
  }
  return std::string{zsh_head} + "typeset -ga _roscell_all=(\n" + commands
         + ")\n" + zsh_cases + cases + zsh_tail;
}

} // namespace roscell::cli
