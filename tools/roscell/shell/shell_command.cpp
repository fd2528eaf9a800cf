#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/shell/child.hpp"
#include "tools/roscell/shell/json_collector.hpp"
#include "tools/roscell/shell/script.hpp"
#include "tools/roscell/shell/session.hpp"
#include "tools/roscell/shell/vocabulary.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <iostream>
#include <memory>
#include <sstream>

namespace roscell::cli {

namespace {

struct shell_options {
  connection_options connection;
  std::string command;
  bool keep_going = false;
};

int run_shell(const shell_options& options, bool has_command) {
  if (json_collector::begins(options.command)) {
    json_collector request;
    std::istringstream lines{options.command};
    for (std::string line; std::getline(lines, line);)
      request.add_line(line);
    return send_by_child(options.connection, request);
  }
  if (has_command)
    return run_line(options.command, options.connection, nullptr);
  if (isatty(STDIN_FILENO) == 1 && stdout_is_terminal())
    return run_session(options.connection);
  return run_script(std::cin, options.connection, options.keep_going);
}

} // namespace

void add_shell_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<shell_options>();
  auto* command = app.add_subcommand("shell", "Interactive shell.");
  command->footer(
      "Every command works here without typing `roscell`. The shell's own "
      "words: `tree` shows\nactors, `follow` shows events while you type, "
      "`exit` ends. A line that begins with {\nbegins a JSON request, which "
      "goes on until its braces close. Tab completes, Ctrl-C ends\nwhat runs, "
      "Ctrl-D the shell. A script on standard input ends at the first line "
      "that fails.\n\n"
      "Examples:\n  roscell shell\n  roscell shell --to 192.168.1.10 "
      "--token-file token\n"
      "  roscell shell -c 'tasks fleet-poses'\n"
      "  roscell shell < morning.txt");
  add_connection_options(*command, options->connection);
  auto* given = command
                    ->add_option("-c,--command", options->command,
                                 "Do this and end, with its exit code")
                    ->option_text("COMMAND");
  command->add_flag("--keep-going", options->keep_going,
                    "Go on with a script after a line that has failed");
  command->callback([&chosen, options, given] {
    const bool has_command = given->count() > 0;
    chosen = [options, has_command] {
      return run_shell(*options, has_command);
    };
  });
}

} // namespace roscell::cli
