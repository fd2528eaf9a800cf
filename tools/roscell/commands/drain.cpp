#include "messages/event_kinds.hpp"
#include "messages/formation.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/wait_finished.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct drain_options {
  connection_options connection;
  std::string output = "table";
  std::string timeout = "120";
  std::string node;
  bool force = false;
  bool until_empty = false;
};

using drain_options_ptr = std::shared_ptr<drain_options>;

json ask(const drain_options& options, const node_client& node,
         const json& request) {
  return unless_refused(node.post("/v1/requests", request.dump(),
                                  parse_duration(options.timeout)),
                        options.output == "json");
}

void print_progress(const node_drained& x) {
  const auto node = "node '" + printable(x.node) + "'";
  if (x.left.empty())
    return print_note(node + " is empty and takes nothing new");
  print_note(node + " takes nothing new; " + std::to_string(x.left.size())
             + " of its instances leave: " + printable(joined(x.left, ", ")));
  if (!x.problem.empty())
    print_note("they cannot at present: " + printable(x.problem));
}

/// What moves, what waits and what is wrong is told on the way.
void wait_until_empty(const node_client& node, const std::string& name,
                      uint64_t since) {
  bool empty = false;
  follow_events(node, since, [&](const event& e) {
    const bool moved =
        e.what == events::instance_moved && event_text(e, "from") == name;
    const bool awaited =
        e.what == events::instance_awaited && event_text(e, "node") == name;
    if (moved)
      print_note(printable(event_text(e, "task") + "/" + event_text(e, "step")
                           + " runs on " + event_text(e, "to")));
    else if (awaited)
      print_note(printable("waits for '" + event_text(e, "task") + "/"
                           + event_text(e, "step") + "' to be stop-safe"));
    else if (e.what == events::node_drain_stuck && e.subject == name)
      print_note(printable("it cannot be emptied at present: "
                           + event_text(e, "reason")));
    empty = e.what == events::node_drained && e.subject == name;
    return !empty;
  });
  if (!empty)
    throw command_error{exit_unreachable, "the node has ended the stream",
                        "`roscell nodes` shows what is left"};
  print_note("node '" + printable(name) + "' is empty");
}

int drain(const drain_options& options) {
  const node_client node{options.connection};
  const auto since = options.until_empty ? last_event_of_coordinator(node) : 0;
  const auto reply =
      ask(options, node, message_json(node_drain{options.node, options.force}));
  const auto progress = reply.get<node_drained>();
  if (options.output == "json")
    print(pretty(reply));
  else
    print_progress(progress);
  if (options.until_empty && !progress.left.empty())
    wait_until_empty(node, options.node, since);
  return exit_done;
}

int undrain(const drain_options& options) {
  const node_client node{options.connection};
  const auto reply =
      ask(options, node, message_json(node_undrain{options.node}));
  if (options.output == "json")
    print(pretty(reply));
  else
    print_note("node '" + printable(options.node) + "' takes instances again");
  return exit_done;
}

CLI::App* add_command(CLI::App& app, const char* name, const char* description,
                      const char* footer, const drain_options_ptr& options) {
  auto* command = app.add_subcommand(name, description);
  command->footer(footer);
  add_connection_options(*command, options->connection);
  add_timeout_option(*command, options->timeout);
  add_output_option(*command, options->output);
  command->add_option("NODE", options->node, "Name of the node")
      ->required()
      ->option_text(" ");
  return command;
}

} // namespace

void add_drain_commands(CLI::App& app, action& chosen) {
  auto options = std::make_shared<drain_options>();
  auto* command = add_command(
      app, "drain",
      "Move every instance away from a node, which takes no new one.",
      "Steps move as others have room for them; those that have to be "
      "stop-safe "
      "first are waited\nfor. It stays so over restarts, until `roscell "
      "undrain`.\n\n"
      "Examples:\n  roscell drain arm-1\n  roscell drain arm-1 --until-empty",
      options);
  command->add_flag("--until-empty", options->until_empty,
                    "Wait until nothing is left on it");
  command->add_flag("--force", options->force,
                    "Do not wait any longer for what is not stop-safe");
  command->callback(
      [&chosen, options] { chosen = [options] { return drain(*options); }; });
  auto again = std::make_shared<drain_options>();
  add_command(app, "undrain", "Let a node take instances again.",
              "Examples:\n  roscell undrain arm-1", again)
      ->callback(
          [&chosen, again] { chosen = [again] { return undrain(*again); }; });
}

} // namespace roscell::cli
