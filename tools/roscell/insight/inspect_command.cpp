#include "messages/insight/examination.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/insight/insight_views.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct inspect_options {
  connection_options connection;
  std::string output = "table";
  std::string actor;
  std::string node; ///< Empty: the one that is asked.
};

/// A blocked actor is waited for by the node, not longer than this.
constexpr std::chrono::seconds inspect_limit{30};

std::string heading(const actor_row& x) {
  const auto us = [](uint64_t value) {
    return span_text(static_cast<int64_t>(value));
  };
  return printable(x.name) + " " + std::to_string(x.id) + ": "
         + std::to_string(x.messages) + " messages, "
         + std::to_string(x.mailbox) + " waiting, busy " + us(x.busy_us)
         + ", longest " + us(x.longest_us) + "\n";
}

std::string actor_text(const inspected_actor_row& x) {
  if (x.state.empty())
    return heading(x.counters)
           + "  no answer in time: it is busy, or blocked\n";
  return heading(x.counters) + state_text(json::parse(x.state), 2);
}

int inspect(const inspect_options& options) {
  const bool as_json = options.output == "json";
  const auto reply = unless_refused(
      node_client{options.connection}.post(
          "/v1/requests",
          message_json(actor_query{options.actor, options.node}).dump(),
          inspect_limit),
      as_json);
  if (as_json) {
    print(pretty(reply));
    return exit_done;
  }
  std::string text;
  for (const auto& x : reply.get<actor_inspection>().actors)
    text += (text.empty() ? "" : "\n") + actor_text(x);
  print(text);
  return exit_done;
}

} // namespace

void add_inspect_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<inspect_options>();
  auto* command =
      app.add_subcommand("inspect", "Show what an actor of the node knows.");
  command->footer(
      "ACTOR is an id, or a name that several may have: all of them are "
      "shown, 64 at most.\n`roscell status --actors` lists them. An actor that "
      "gives no answer within 10 s is shown\nwith its counters alone.\n\n"
      "Examples:\n  roscell inspect cell-coordinator\n"
      "  roscell inspect membership --node arm-1\n"
      "  roscell inspect 22 -o json | jq .actors[0].state");
  add_connection_options(*command, options->connection);
  add_output_option(*command, options->output);
  command->add_option("ACTOR", options->actor, "Its name or id")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--node", options->node,
                   "Of this node of the cell, asked by its coordinator")
      ->option_text("NODE [the one that is asked]");
  command->callback(
      [&chosen, options] { chosen = [options] { return inspect(*options); }; });
}

} // namespace roscell::cli
