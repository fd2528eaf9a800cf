#include "tools/roscell/client/event_stream.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct events_options {
  connection_options connection;
  std::string output = "table";
  uint64_t since = from_now_on;
  uint64_t count = 0; ///< 0: no end.
};

int show_events(const events_options& options) {
  end_quietly_on_interrupt();
  const bool as_json = options.output == "json";
  const node_client node{options.connection};
  uint64_t shown = 0;
  follow_events(node, options.since, [&](const event& e) {
    if (!as_json && shown == 0)
      print(event_heading() + "\n");
    print(as_json ? compact(message_json(e))
                  : shortened_line(event_line(e)) + "\n");
    return ++shown != options.count;
  });
  if (options.count == 0 || shown != options.count)
    throw command_error{exit_unreachable, "the node has ended the stream"};
  return exit_done;
}

} // namespace

void add_events_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<events_options>();
  auto* command = app.add_subcommand(
      "events", "Follow what happens on a node. Ctrl-C ends.");
  command->footer("Examples:\n  roscell events\n"
                  "  roscell events --since 0 -n 20\n"
                  "  roscell events -o json | jq .event");
  add_connection_options(*command, options->connection);
  command
      ->add_option("--since", options->since,
                   "Begin after the event of this number; 0: with the oldest "
                   "that is kept. Without it only new ones are shown")
      ->check(CLI::Range(uint64_t{0}, from_now_on))
      ->option_text("NUMBER");
  command->add_option("-n,--count", options->count, "End after so many events")
      ->check(CLI::Range(uint64_t{1}, from_now_on))
      ->option_text("COUNT");
  add_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return show_events(*options); };
  });
}

} // namespace roscell::cli
