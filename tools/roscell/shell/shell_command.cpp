#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/completion/completion.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/child.hpp"
#include "tools/roscell/shell/editing/line_editor.hpp"
#include "tools/roscell/shell/json_collector.hpp"
#include "tools/roscell/shell/vocabulary.hpp"
#include "tools/roscell/split_words.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <unistd.h>

#include <iostream>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

namespace roscell::cli {

namespace {

std::string prompt_for(const node_connection_status& status,
                       const target& where) {
  const auto name = status.node.empty() ? where.text() : status.node;
  if (!status.is_reachable)
    return printable(name) + " (lost)> ";
  return printable(status.cell.empty() ? name : name + "@" + status.cell)
         + "> ";
}

/// One shell at a terminal.
class shell_session {
public:
  explicit shell_session(const connection_options& connection)
      : connection_{connection}, node_{connection}, names_{node_},
        kept_{default_history()}, editor_{calls(), kept_}, events_{node_},
        live_{events_} {
    // Every process that is started from here asks the same node.
    connection_.to = node_.where().text();
    set_up_vocabulary(app_, ignored_, &live_);
  }

  int run() {
    events_.await_first_answer();
    print_note("`help` lists what can be said here; Tab completes, Ctrl-D "
               "ends");
    while (!live_.ended && read_one()) {
      // Until its end.
    }
    return exit_done;
  }

private:
  editor_calls calls() {
    return {[this] {
              return request_.is_open()
                         ? "... "
                         : prompt_for(events_.status(), node_.where());
            },
            [this](std::string_view line) { return completed(line); },
            [this] { return events_.news_fd(); },
            [this] { return events_.take_lines(); }};
  }

  completions completed(std::string_view line) {
    if (request_.is_open() || json_collector::begins(line))
      return {};
    return complete(app_, line,
                    [this](const std::string& kind) { return names_of(kind); });
  }

  std::vector<std::string> names_of(const std::string& kind) {
    if (kind == "kinds") {
      const auto known = events_.kinds();
      return {known.begin(), known.end()};
    }
    if (!events_.status().is_reachable)
      return {};
    if (kind != "subjects")
      return names_.of(kind);
    std::vector<std::string> all;
    for (const auto* x : {"nodes", "tasks", "instances"})
      all.insert(all.end(), names_.of(x).begin(), names_.of(x).end());
    return all;
  }

  /// False at the end.
  bool read_one() {
    editor_.show_news();
    std::string line;
    switch (editor_.read(line)) {
    case line_editor::outcome::ended:
      print("\n");
      return false;
    case line_editor::outcome::interrupted:
      print("^C\n");
      drop_request();
      return true;
    case line_editor::outcome::line:
      try_to_take(line);
      return true;
    }
    return false;
  }

  /// A line that cannot be done does not end the shell.
  void try_to_take(const std::string& line) {
    try {
      take(line);
    } catch (const command_error& e) {
      print_error(e.what(), e.hint);
    }
  }

  void take(const std::string& line) {
    if (request_.is_open() || json_collector::begins(line))
      return take_json(line);
    editor_.remember(line.substr(0, line.find_last_not_of(" \t") + 1));
    const auto words = without_program(split_words(line).words);
    if (words.empty())
      return;
    if (changes_shell(words))
      run_line(line, connection_, &live_);
    else
      run_child(connection_, line, child_input::shared);
    end_command();
  }

  /// The terminal shows ^C or ^\ where the cursor was. Who asks a node that is
  /// lost expects it back.
  void end_command() {
    events_.refresh_now();
    if (editor_.forget_interrupts())
      print("\n");
  }

  void take_json(const std::string& line) {
    request_.add_line(line);
    if (request_.is_open())
      return;
    const auto request = std::exchange(request_, {});
    editor_.remember(request.one_line());
    send_by_child(connection_, request);
    end_command();
  }

  /// What was typed of it comes back from the history.
  void drop_request() {
    if (request_.is_open())
      editor_.remember(std::exchange(request_, {}).one_line());
  }

  connection_options connection_;
  const node_client node_;
  live_names names_;
  history_file kept_;
  CLI::App app_; ///< For completion; nothing of it is ever done.
  action ignored_;
  json_collector request_;
  line_editor editor_; // Before what has threads.
  follower events_;
  live_shell live_;
};

/// The shell at a terminal: reads lines and does what they say until its end.
/// Returns the exit code.
int run_session(const connection_options& connection) {
  return shell_session{connection}.run();
}

/// One script that is run.
class script_run {
public:
  explicit script_run(const connection_options& connection)
      : connection_{connection} {}

  /// The exit code of the line; none if nothing is done for it yet.
  std::optional<int> take(const std::string& line) {
    if (request_.is_open() || json_collector::begins(line))
      return take_json(line);
    const auto words = without_program(split_words(line).words);
    if (words.empty() || words.front().rfind('#', 0) == 0)
      return std::nullopt;
    ends_ = words.front() == "exit" || words.front() == "quit";
    return run_child(connection_, line, child_input::nothing);
  }

  /// Whether the script has said that it ends.
  bool ends() const {
    return ends_;
  }

  /// The exit code of what is left at the end of the script.
  int finish() const {
    return request_.is_open() ? send_by_child(connection_, request_)
                              : exit_done;
  }

private:
  std::optional<int> take_json(const std::string& line) {
    request_.add_line(line);
    if (request_.is_open())
      return std::nullopt;
    return send_by_child(connection_, std::exchange(request_, {}));
  }

  const connection_options& connection_;
  json_collector request_;
  bool ends_ = false;
};

void print_failure(size_t number, int code) {
  print_note("roscell: line " + std::to_string(number)
             + " has failed with exit code " + std::to_string(code));
}

/// Does what the lines say, one after the other, until one fails, or to the end
/// with `keep_going`; then that is said with the line's number. Empty lines and
/// those that begin with # say nothing. Returns the exit code of the first that
/// failed.
int run_script(std::istream& lines, const connection_options& connection,
               bool keep_going) {
  script_run script{connection};
  int first_failure = exit_done;
  size_t number = 0;
  const auto failed = [&](int code) {
    if (code == exit_done)
      return false;
    print_failure(number, code);
    if (first_failure == exit_done)
      first_failure = code;
    return !keep_going;
  };
  for (std::string line; !script.ends() && std::getline(lines, line);) {
    ++number;
    if (failed(script.take(line).value_or(exit_done)))
      return first_failure;
  }
  failed(script.finish());
  return first_failure;
}

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
