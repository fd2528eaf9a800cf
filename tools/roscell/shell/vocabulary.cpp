#include "tools/roscell/shell/vocabulary.hpp"

#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/split_words.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace roscell::cli {

namespace {

bool names_target(const std::vector<std::string>& words) {
  return std::any_of(words.begin(), words.end(), [](const auto& x) {
    return x == "--to" || x.rfind("--to=", 0) == 0;
  });
}

/// Every command takes its node from the environment if its line names none.
void set_target(const connection_options& connection) {
  if (connection.to.empty())
    return;
  setenv("ROSCELL_TO", connection.to.c_str(), 1);
  if (connection.token_file.empty())
    return;
  const auto token =
      find_token(connection.token_file, parse_target(connection.to));
  setenv("ROSCELL_TOKEN", token.c_str(), 1);
}

/// What makes no sense in a shell.
void refuse_misplaced(const std::vector<std::string>& words) {
  if (words.front() == "shell")
    throw command_error{exit_usage, "this is the shell already",
                        "`exit` ends it"};
  if (words.front() == "node")
    throw command_error{exit_usage, "a node would end with this shell",
                        "start `roscell node` in a terminal of its own, or as "
                        "a service"};
}

std::vector<std::string> arguments_of(const std::string& line) {
  auto split = split_words(line);
  if (split.open != '\0')
    throw command_error{exit_usage,
                        split.open == '\\'
                            ? std::string{"nothing stands behind the last \\"}
                            : "the quote " + std::string(1, split.open)
                                  + " is not closed"};
  return without_program(std::move(split.words));
}

} // namespace

void set_up_vocabulary(CLI::App& app, action& chosen, live_shell* shell) {
  add_tree_builtin(app, chosen);
  add_follow_builtin(app, chosen, shell);
  add_exit_builtin(app, chosen, shell);
  set_up(app, chosen);
}

bool changes_shell(const std::vector<std::string>& words) {
  constexpr std::array<std::string_view, 3> names{"follow", "exit", "quit"};
  return !words.empty()
         && std::find(names.begin(), names.end(), words.front()) != names.end();
}

int run_line(const std::string& line, const connection_options& connection,
             live_shell* shell) {
  try {
    const auto words = arguments_of(line);
    if (words.empty())
      return exit_done;
    refuse_misplaced(words);
    if (shell == nullptr && !names_target(words))
      set_target(connection);
    return run(
        [shell](CLI::App& app, action& chosen) {
          set_up_vocabulary(app, chosen, shell);
        },
        words);
  } catch (const command_error& e) {
    print_error(e.what(), e.hint);
    return e.code;
  }
}

} // namespace roscell::cli
