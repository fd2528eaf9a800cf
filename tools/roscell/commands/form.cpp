#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/plan_view.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <memory>

namespace roscell::cli {

namespace {

struct form_options {
  connection_options connection;
  std::string output = "table";
  std::string instances = "refuse";
  /// Longer than the coordinator's own limit, so that its answer is heard.
  std::string timeout = "16m";
  std::vector<std::string> nodes;
  std::string target;
  std::string cell; ///< That the node is in.

  instance_policy policy() const {
    return json(instances).get<instance_policy>();
  }
};

using form_options_ptr = std::shared_ptr<form_options>;

json send(const form_options& options, const json& request) {
  const auto limit = parse_duration(options.timeout);
  const node_client node{options.connection};
  const auto words = [&nodes = options.nodes](const event& e) {
    return movement_lines(e, nodes);
  };
  const auto body = request.dump();
  auto reply = stderr_is_terminal()
                   ? post_with_progress(node, body, limit, words)
                   : node.post("/v1/requests", body, limit);
  return unless_refused(std::move(reply), options.output == "json");
}

template <class Reply>
Reply show(const form_options& options, const json& request,
           std::string (*view)(const Reply&, const view_style&)) {
  const auto reply = send(options, request);
  auto result = reply.get<Reply>();
  print(options.output == "json" ? pretty(reply)
                                 : view(result, view_style_now()));
  return result;
}

int form(const form_options& options) {
  const cell_formation request{options.nodes, options.policy()};
  const auto formed = show(options, message_json(request), formation_view);
  if (options.output != "json")
    for (const auto& hint : hints_of(formed))
      print_note("hint: " + printable(hint));
  const auto& all = formed.outcomes;
  return std::any_of(all.begin(), all.end(),
                     [](const formation_outcome& x) {
                       return x.result == formation_result::failed;
                     })
             ? exit_refused
             : exit_done;
}

int transfer(const form_options& options) {
  node_transfer request;
  request.node = options.nodes.front();
  request.target = options.target;
  request.cell = options.cell;
  request.instances = options.policy();
  show(options, message_json(request), transferred_view);
  return exit_done;
}

int release(const form_options& options) {
  node_release request;
  request.node = options.nodes.front();
  request.cell = options.cell;
  request.instances = options.policy();
  show(options, message_json(request), released_view);
  return exit_done;
}

void add_node_argument(CLI::App& command, form_options& options) {
  options.nodes.resize(1);
  command.add_option("NODE", options.nodes.front(), "Name of the node")
      ->required()
      ->option_text(" ");
  command
      .add_option("--cell", options.cell,
                  "The cell that the node is in, if not the asked one")
      ->option_text("CELL");
}

CLI::App* add_form_command(CLI::App& app, const char* name,
                           const char* description, const char* footer,
                           const form_options_ptr& options) {
  auto* command = app.add_subcommand(name, description);
  command->footer(footer);
  add_connection_options(*command, options->connection);
  command
      ->add_option("--instances", options->instances,
                   "What becomes of the instances on a node that leaves its "
                   "cell: it stays where it is, their tasks are terminated, "
                   "or they go to other members first")
      ->check(CLI::IsMember({"refuse", "terminate", "reschedule"}))
      ->option_text("refuse|terminate|reschedule [refuse]");
  add_timeout_option(*command, options->timeout);
  add_output_option(*command, options->output);
  return command;
}

void add_form(CLI::App& app, action& chosen) {
  auto options = std::make_shared<form_options>();
  auto* command = add_form_command(
      app, "form",
      "Bring nodes into the cell of the coordinator that is asked.",
      "Nodes that are in no cell are brought in, members of other cells are\n"
      "transferred, members of this cell stay. Exit code 1: one of them could "
      "not come;\nthe others have.\n\n"
      "Examples:\n  roscell form arm-1 arm-2 edge-3\n"
      "  roscell form --to 192.168.1.10 --instances reschedule arm-1",
      options);
  command->add_option("NAME", options->nodes, "Names of the nodes")
      ->required()
      ->option_text("...");
  command->callback(
      [&chosen, options] { chosen = [options] { return form(*options); }; });
}

void add_transfer(CLI::App& app, action& chosen) {
  auto options = std::make_shared<form_options>();
  auto* command = add_form_command(
      app, "transfer", "Move a node to another cell.",
      "Any coordinator can be asked. Ctrl-C ends the waiting, not the "
      "transfer:\n`roscell transfers` shows how it stands.\n\n"
      "Examples:\n  roscell transfer arm-1 hall\n"
      "  roscell transfer --instances terminate arm-1 hall",
      options);
  add_node_argument(*command, *options);
  command->add_option("CELL", options->target, "Name of the cell")
      ->required()
      ->option_text(" ");
  command->callback([&chosen, options] {
    chosen = [options] { return transfer(*options); };
  });
}

void add_release(CLI::App& app, action& chosen) {
  auto options = std::make_shared<form_options>();
  auto* command = add_form_command(
      app, "release", "Make a node independent of its cell.",
      "Any coordinator can be asked. A released node waits until it is chosen: "
      "it asks\nfor no place by itself.\n\n"
      "Examples:\n  roscell release arm-1\n"
      "  roscell release --instances reschedule arm-1",
      options);
  add_node_argument(*command, *options);
  command->callback(
      [&chosen, options] { chosen = [options] { return release(*options); }; });
}

} // namespace

void add_form_commands(CLI::App& app, action& chosen) {
  add_form(app, chosen);
  add_transfer(app, chosen);
  add_release(app, chosen);
}

} // namespace roscell::cli
