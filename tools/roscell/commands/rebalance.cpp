#include "messages/rebalance.hpp"
#include "messages/event_kinds.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/wait_finished.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct rebalance_options {
  connection_options connection;
  std::string output = "table";
  std::string timeout = "120";
  cell_rebalance request;

  bool as_json() const {
    return output == "json";
  }
};

void print_step(const event& e) {
  const auto step = event_text(e, "task") + "/" + event_text(e, "step");
  if (e.what == events::instance_moved)
    print_note(printable(step + " runs on " + event_text(e, "to")));
  else if (e.what == events::instance_awaited)
    print_note(printable("waits for '" + step + "' to be stop-safe"));
}

/// Waits for the last move. Ctrl-C ends the waiting only.
int wait_until_moved(const node_client& node, uint64_t since) {
  event last;
  follow_events(node, since, [&](const event& e) {
    print_step(e);
    if (e.what == events::rebalance_ended)
      last = e;
    return last.what.empty();
  });
  if (last.what.empty())
    throw command_error{exit_unreachable, "the node has ended the stream",
                        "`roscell rebalance --dry-run` shows what is left"};
  const auto reason = event_text(last, "reason");
  if (reason.empty()) {
    print_note("all moves are made");
    return exit_done;
  }
  print_note(printable("the moves have ended: " + reason));
  return exit_refused;
}

int rebalance(const rebalance_options& options) {
  const node_client node{options.connection};
  const bool makes_moves = !options.request.dry_run && !options.request.stop;
  const auto since = makes_moves ? last_event_of_coordinator(node) : 0;
  const auto reply = unless_refused(
      node.post("/v1/requests", message_json(options.request).dump(),
                parse_duration(options.timeout)),
      options.as_json());
  const auto report = reply.get<cell_rebalanced>();
  print(options.as_json() ? pretty(reply)
                          : rebalance_view(report, stdout_style()));
  return makes_moves && report.running ? wait_until_moved(node, since)
                                       : exit_done;
}

} // namespace

void add_rebalance_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<rebalance_options>();
  auto* command = app.add_subcommand(
      "rebalance", "Move running steps to where the cell is better balanced.");
  command->footer(
      "Each move makes the total of the paper's equation (1) better for all "
      "that runs. They are\nmade one by one: the new instance runs before the "
      "old one ends, unless that has to be\nsafe first, and has to stay "
      "healthy for a while before the next one moves. Ctrl-C ends\nthe "
      "waiting, --stop the moves.\n\n"
      "Examples:\n  roscell rebalance --dry-run\n"
      "  roscell rebalance --min-gain 0.01\n  roscell rebalance --stop");
  add_connection_options(*command, options->connection);
  add_timeout_option(*command, options->timeout);
  add_output_option(*command, options->output);
  auto& request = options->request;
  command->add_flag("--dry-run", request.dry_run, "Only show the moves");
  command
      ->add_option("--min-gain", request.min_gain,
                   "Make no move that gains a smaller part of the total")
      ->option_text("GAIN [0.01]");
  command
      ->add_option("--most", request.most_moves, "Make no more moves than this")
      ->option_text("N [32]");
  command->add_flag("--force", request.force,
                    "Do not wait for what is not stop-safe");
  command->add_flag("--stop", request.stop,
                    "The move that is being made is the last one");
  command->callback([&chosen, options] {
    chosen = [options] { return rebalance(*options); };
  });
}

} // namespace roscell::cli
