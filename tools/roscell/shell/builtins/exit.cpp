#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/builtins/builtins.hpp"

#include <CLI/CLI.hpp>

namespace roscell::cli {

void add_exit_builtin(CLI::App& app, action& chosen, live_shell* shell) {
  auto* word = app.add_subcommand("exit", "End the shell, as Ctrl-D does.");
  word->alias("quit")->group(own_announcement);
  word->callback([&chosen, shell] {
    chosen = [shell] {
      if (shell != nullptr)
        shell->ended = true;
      return exit_done;
    };
  });
}

} // namespace roscell::cli
