#include "tools/roscell/commands/completion.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

namespace roscell::cli {

namespace {

/// `text` as one word of fish.
std::string fish_word(const std::string& text) {
  std::string result = "'";
  for (const char x : text) {
    if (x == '\'' || x == '\\')
      result += '\\';
    result += x;
  }
  return result + "'";
}

/// The words that are offered for what `action_of` says.
std::string fish_offers(const CLI::Option& option) {
  return " -a '(__roscell_" + action_of(option) + ")'";
}

std::string fish_option(const CLI::App& command, const CLI::Option& option) {
  auto line =
      "complete -c roscell -n '__roscell_in " + command.get_name() + "'";
  for (const auto& name : option.get_snames())
    line += " -s " + name;
  for (const auto& name : option.get_lnames())
    line += " -l " + name;
  line += " -d " + fish_word(option.get_description());
  if (option.get_items_expected_max() != 0)
    line += " -x" + fish_offers(option);
  return line + "\n";
}

/// The lines of one command: its options, then its arguments by their places,
/// of which the last may be repeated.
std::string fish_lines(const CLI::App& command) {
  std::string lines;
  std::vector<std::string> arguments;
  std::vector<std::string> with_value;
  for (const auto* option : command.get_options()) {
    if (option->get_positional()) {
      arguments.push_back(fish_offers(*option));
      continue;
    }
    lines += fish_option(command, *option);
    if (option->get_items_expected_max() != 0)
      for (auto& name : names_of(*option))
        with_value.push_back(std::move(name));
  }
  for (size_t i = 0; i < arguments.size(); ++i)
    lines += "complete -c roscell -n '__roscell_at " + command.get_name() + " "
             + std::to_string(i + 1)
             + (i + 1 < arguments.size() ? " one " : " on ")
             + joined(with_value, " ") + "'" + arguments[i] + "\n";
  return lines;
}

constexpr auto fish_head = R"fish(# fish completion for roscell; to use it:
#   roscell completion fish > ~/.config/fish/completions/roscell.fish

function __roscell_words
    printf '%s\n' $argv
end

function __roscell_capacity
    __roscell_words cpu= memory_mib= disk_mib=
end

function __roscell_files
    __fish_complete_path (commandline -ct)
end

function __roscell_dirs
    __fish_complete_directories (commandline -ct)
end

function __roscell_nothing
end

function __roscell_interfaces
    command ls /sys/class/net 2>/dev/null
end

# Ids are the first column of a table; what the node refuses is not shown, and
# one that does not answer at once is not waited for.
function __roscell_ids
    set -l words (commandline -opc)
    set -l to
    for i in (seq 2 (math (count $words) - 1))
        if contains -- $words[$i] --to --token-file
            set to $to $words[$i] $words[(math $i + 1)]
        end
    end
    ROSCELL_TIMEOUT=600ms roscell $argv $to 2>/dev/null |
        awk 'NR > 1 && $1 ~ /^[A-Za-z0-9._-]+$/ { print $1 }'
end

# True in the command $argv[1].
function __roscell_in
    set -l words (commandline -opc)
    test (count $words) -ge 2; and test $words[2] = $argv[1]
end

# True at the argument number $argv[2] of the command $argv[1], and with "on"
# at those after it. The options after that take a value.
function __roscell_at
    __roscell_in $argv[1]; or return 1
    set -l words (commandline -opc)
    set -l with_value $argv
    set -e words[1..2]
    set -e with_value[1..3]
    set -l place 1
    set -l is_value 0
    for word in $words
        if test $is_value = 1
            set is_value 0
        else if contains -- $word $with_value
            set is_value 1
        else if not string match -q -- '-*' $word
            set place (math $place + 1)
        end
    end
    test $place -eq $argv[2]; and return 0
    test $argv[3] = on; and test $place -gt $argv[2]
end

function __roscell_first
    test (count (commandline -opc)) -eq 1
end

complete -c roscell -f
)fish";

} // namespace

std::string fish_completion(const CLI::App& app) {
  std::string commands;
  std::vector<std::string> names;
  std::string lines;
  for (const auto* command : app.get_subcommands({})) {
    names.push_back(command->get_name());
    commands += "complete -c roscell -n __roscell_first -a "
                + command->get_name() + " -d "
                + fish_word(command->get_description()) + "\n";
    lines += fish_lines(*command);
  }
  return std::string{fish_head} + "\nfunction __roscell_commands\n    "
         + "__roscell_words " + joined(names, " ") + "\nend\n\n" + commands
         + lines;
}

} // namespace roscell::cli
