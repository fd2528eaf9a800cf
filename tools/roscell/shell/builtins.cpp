#include "tools/roscell/shell/builtins.hpp"

#include "client/columns.hpp"
#include "messages/codec/json_codec.hpp"
#include "messages/node.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/views.hpp"

#include <CLI/CLI.hpp>

#include <chrono>
#include <memory>
#include <optional>

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

namespace {

struct follow_options {
  event_filter filter;
  bool off = false;
};

int begin_to_follow(const follow_options& options, live_shell* shell) {
  if (shell == nullptr)
    throw command_error{exit_usage,
                        "`follow` shows events above a line that is typed, and "
                        "nobody types here",
                        "`events` follows them as a command"};
  if (options.off) {
    shell->events.show(std::nullopt);
    print("events are not shown any more\n");
    return exit_done;
  }
  shell->events.show(options.filter);
  print("shows " + printable(options.filter.text())
        + "; `follow --off` ends it\n");
  return exit_done;
}

} // namespace

void add_follow_builtin(CLI::App& app, action& chosen, live_shell* shell) {
  auto options = std::make_shared<follow_options>();
  auto* word = app.add_subcommand(
      "follow", "Show events above the line that is typed, from now on.");
  word->group(own_announcement);
  word->footer("While a command runs they wait for its end.\n\n"
               "Examples:\n  follow\n  follow node_* task_failed\n"
               "  follow -s arm-1 -s fleet-poses\n  follow --off");
  word->add_option("KIND", options->filter.kinds,
                   "Only such events; with a * at the end all whose name "
                   "begins so")
      ->option_text(" ");
  word->add_option("-s,--subject", options->filter.subjects,
                   "Only those about this node, task, step or instance; can "
                   "be repeated")
      ->option_text("NAME")
      ->expected(1)
      ->take_all();
  word->add_flag("--off", options->off, "Show none from now on");
  word->callback([&chosen, options, shell] {
    chosen = [options, shell] { return begin_to_follow(*options, shell); };
  });
}

namespace {

/// Longer than a coordinator waits for another node.
constexpr std::chrono::seconds tree_limit{30};

struct tree_options {
  std::string node; ///< Empty: the one that is asked.
  std::string output = "table";
};

int show_tree(const tree_options& options) {
  node_query query;
  query.actors = true;
  query.node = options.node;
  const auto reply = node_client{{}}.ask(message_json(query), tree_limit);
  if (options.output == "json") {
    print(pretty(reply.at("actors")));
    return exit_done;
  }
  const auto node = reply.get<node_description>();
  print(printable(node.identity.name) + ", " + role_text(node.role)
        + (node.cell.empty() ? "" : " in cell " + printable(node.cell)) + "\n\n"
        + actors_view(node.actors, view_style_now()));
  return exit_done;
}

} // namespace

void add_tree_builtin(CLI::App& app, action& chosen) {
  auto options = std::make_shared<tree_options>();
  auto* word = app.add_subcommand(
      "tree",
      "Show the tree of actors of a node: what waits for them, and their "
      "time.");
  word->group(own_announcement);
  word->footer("Another node of the cell is asked by its coordinator.\n\n"
               "Examples:\n  tree\n  tree arm-1\n  tree -o json");
  word->add_option("NODE", options->node, "A node of the cell; none: this one")
      ->option_text(" ");
  add_output_option(*word, options->output);
  word->callback([&chosen, options] {
    chosen = [options] { return show_tree(*options); };
  });
}

} // namespace roscell::cli
