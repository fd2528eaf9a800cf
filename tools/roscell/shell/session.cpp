#include "tools/roscell/shell/session.hpp"

#include "tools/roscell/completion/live_names.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/shell/child.hpp"
#include "tools/roscell/shell/editing/line_editor.hpp"
#include "tools/roscell/shell/json_collector.hpp"
#include "tools/roscell/shell/vocabulary.hpp"
#include "tools/roscell/split_words.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

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

} // namespace

int run_session(const connection_options& connection) {
  return shell_session{connection}.run();
}

} // namespace roscell::cli
