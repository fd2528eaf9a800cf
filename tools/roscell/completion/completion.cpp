#include "tools/roscell/completion/completion.hpp"

#include "tools/roscell/commands.hpp"
#include "tools/roscell/completion/live_names.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/split_words.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

namespace roscell::cli {

namespace {

constexpr std::string_view plain_letters =
    "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-_./:=@";

// A colon or an equals sign begins a word of its own for bash.
constexpr auto bash_script =
    R"bash(# bash completion for roscell; to use it now:
#   source <(roscell completion bash)
# and for good:
#   roscell completion bash > /etc/bash_completion.d/roscell

_roscell() {
  local cur=${COMP_WORDS[COMP_CWORD]} line=${COMP_LINE:0:COMP_POINT}
  local typed=${line##* } word meaning
  [[ $cur != [:=] ]] || cur=
  COMPREPLY=()
  while IFS=$'\t' read -r word meaning; do
    case $word in
      :files) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -f -- "$cur") ;;
      :dirs) compopt -o filenames; mapfile -t COMPREPLY < <(compgen -d -- "$cur") ;;
      :more) compopt -o nospace ;;
      *) COMPREPLY+=("${word:$((${#typed} - ${#cur}))}") ;;
    esac
  done < <(roscell completion --line "$line" 2>/dev/null)
}

complete -F _roscell roscell
)bash";

constexpr auto zsh_script = R"zsh(#compdef roscell
# zsh completion for roscell; put it into a directory of $fpath:
#   roscell completion zsh > /usr/local/share/zsh/site-functions/_roscell

_roscell() {
  local line="${(j: :)words[1,CURRENT-1]} $PREFIX" x
  local -a found more
  for x in "${(@f)$(roscell completion --line "$line" 2>/dev/null)}"; do
    case ${x%%$'\t'*} in
      '') ;;
      :files) _files; return ;;
      :dirs) _files -/; return ;;
      :more) more=(-S '') ;;
      *) found+=("${${x%%$'\t'*}//:/\\:}:${x#*$'\t'}") ;;
    esac
  done
  _describe word found $more
}

# The file is loaded as a function, or read by `source`.
if [[ $ZSH_EVAL_CONTEXT == *(shfunc|loadautofunc) ]]; then
  _roscell "$@"
else
  compdef _roscell roscell
fi
)zsh";

constexpr auto fish_script = R"fish(# fish completion for roscell; to use it:
#   roscell completion fish > ~/.config/fish/completions/roscell.fish

function __roscell_offers
    for x in (roscell completion --line (commandline -cp) 2>/dev/null)
        switch (string split \t -- $x)[1]
            case ':files'
                __fish_complete_path (commandline -ct)
            case ':dirs'
                __fish_complete_directories (commandline -ct)
            case ':more'
            case '*'
                echo $x
        end
    end
end

complete -c roscell -f -a '(__roscell_offers)'
)fish";

bool is_plain(const std::string& word) {
  return word.find_first_not_of(plain_letters) == word.npos;
}

/// The node that a line names, which is asked for names.
connection_options connection_in(std::string_view line) {
  connection_options result;
  const auto split = split_words(line);
  const auto& words = split.words;
  // The word that is being typed is no value yet.
  const auto whole = words.size() - (split.in_word ? 1 : 0);
  for (size_t i = 0; i + 1 < whole; ++i)
    if (words[i] == "--to")
      result.to = words[i + 1];
    else if (words[i] == "--token-file")
      result.token_file = words[i + 1];
  return result;
}

int print_completions(const CLI::App& app, const std::string& line) {
  const node_client node{connection_in(line)};
  live_names names{node};
  print(completion_lines(
      app, line, [&](const std::string& kind) { return names.of(kind); }));
  return exit_done;
}

} // namespace

std::string completion_script(const std::string& shell) {
  return shell == "zsh"    ? zsh_script
         : shell == "fish" ? fish_script
                           : bash_script;
}

std::string completion_lines(const CLI::App& app, std::string_view line,
                             const name_lookup& names) {
  const auto found = complete(app, line, names);
  if (!found.paths.empty())
    return ":" + found.paths + "\n";
  std::string result = found.goes_on ? ":more\n" : "";
  for (const auto& word : found.words)
    if (is_plain(word)) {
      auto meaning = found.meanings.at(word);
      std::replace(meaning.begin(), meaning.end(), '\n', ' ');
      result += word + "\t" + printable(meaning) + "\n";
    }
  return result;
}

void add_completion_command(CLI::App& app, action& chosen) {
  auto shell = std::make_shared<std::string>();
  auto line = std::make_shared<std::string>();
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
      ->check(CLI::IsMember({"bash", "zsh", "fish"}))
      ->option_text(" ");
  command
      ->add_option("--line", *line,
                   "For these scripts: print what the last word of a line may "
                   "become")
      ->option_text("LINE");
  command->callback([&app, &chosen, shell, line] {
    if (shell->empty() == line->empty())
      throw CLI::RequiredError{"SHELL"};
    chosen = [&app, shell, line] {
      if (!line->empty())
        return print_completions(app, *line);
      print(completion_script(*shell));
      return static_cast<int>(exit_done);
    };
  });
}

} // namespace roscell::cli
