#include "tools/roscell/completion/completion.hpp"

#include "tools/roscell/commands.hpp"
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

namespace {

constexpr std::chrono::milliseconds names_limit{700};
constexpr std::chrono::seconds names_stay{2};

/// Where the names of a kind are: in each item of a list of an answer.
struct name_source {
  std::string_view kind;
  const char* path;
  const char* body;
  const char* list;
  const char* name; ///< JSON pointer in an item, or to models of a skill.
};

constexpr auto transfers_asked = R"({"type":"transfer_query"})";

constexpr name_source name_sources[] = {
    {"nodes", "/v1/cell", "", "nodes", "/identity/name"},
    {"nodes", "/v1/cell", "", "free", "/name"},
    {"cells", "/v1/cells", "", "cells", "/cell"},
    {"tasks", "/v1/tasks", "", "tasks", "/task"},
    {"tasks", "/v1/tasks", "", "sets", "/task"},
    {"instances", "/v1/instances", "", "instances", "/spec/instance"},
    {"secrets", "/v1/secrets", "", "secrets", "/name"},
    {"parameters", "/v1/skills", "", "skills", "/skill/descriptor/models"},
    {"actors", "/v1/node?actors=1", "", "actors", "/name"},
    {"transfers", "/v1/requests", transfers_asked, "transfers", "/transfer"},
};

const name_source* source_of(const std::string& kind) {
  for (const auto& x : name_sources)
    if (x.kind == kind)
      return &x;
  return nullptr;
}

/// "decimation=" for each that some skill takes while it runs.
std::vector<std::string> changeable_in(const json& models) {
  std::vector<std::string> result;
  for (const auto& model : models) {
    const auto parameters = model.value("parameters", json::object());
    for (const auto& [name, x] : parameters.items())
      if (x.is_object() && x.value("changeable", false))
        result.push_back(name + "=");
  }
  return result;
}

} // namespace

std::vector<std::string> names_in(const std::string& kind, const json& reply) {
  std::vector<std::string> result;
  for (const auto& source : name_sources) {
    const auto list = reply.find(source.list);
    if (source.kind != kind || list == reply.end())
      continue;
    const json::json_pointer name{source.name};
    for (const auto& item : *list) {
      if (!item.contains(name))
        continue;
      const auto& found = item.at(name);
      if (found.is_string())
        result.push_back(found.get<std::string>());
      for (auto& x :
           found.is_array() ? changeable_in(found) : std::vector<std::string>{})
        result.push_back(std::move(x));
    }
  }
  return result;
}

const std::vector<std::string>& live_names::of(const std::string& kind) {
  auto& entry = known_[kind];
  const auto* source = source_of(kind);
  const auto now = clock::now();
  const bool is_fresh =
      entry.asked != clock::time_point{} && now - entry.asked < names_stay;
  if (source == nullptr || is_fresh)
    return entry.names;
  entry.asked = now;
  try {
    const std::string request = source->body;
    entry.names = names_in(
        kind, request.empty() ? node_.get(source->path, {names_limit})
                              : node_.ask(json::parse(request), names_limit));
  } catch (const std::runtime_error&) {
    entry.names.clear();
  }
  return entry.names;
}

} // namespace roscell::cli
