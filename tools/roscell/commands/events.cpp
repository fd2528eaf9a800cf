#include "tools/roscell/client/event_words.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <cstddef>
#include <memory>
#include <utility>

namespace roscell::cli {

namespace {

struct events_options {
  connection_options connection;
  std::string output = "table";
  uint64_t since = from_now_on;
  uint64_t count = 0; ///< Of those that are kept, the last ones; 0: no bound.
  bool no_follow = false;

  /// Whether something of what is kept is wanted.
  bool wants_kept() const {
    return no_follow || count != 0 || since != from_now_on;
  }

  /// The number after which events are wanted.
  uint64_t begin() const {
    return wants_kept() && since == from_now_on ? 0 : since;
  }
};

/// Prints events, below a heading if people read them.
class event_printer {
public:
  event_printer(bool as_json, uint64_t begin)
      : as_json_{as_json}, last_{begin} {}

  void print_event(const event& e) {
    if (!as_json_ && !std::exchange(begun_, true))
      print(event_heading(stdout_style().width) + "\n");
    print(as_json_
              ? compact(message_json(e))
              : shortened_line(event_line(e, stdout_style().width)) + "\n");
    last_ = e.sequence;
  }

  /// Number of the last one; if there was none, where they were to begin.
  uint64_t last() const {
    return last_;
  }

private:
  bool as_json_;
  bool begun_ = false;
  uint64_t last_;
};

void print_kept(const events_options& options, const node_client& node,
                event_printer& out) {
  const auto kept = kept_events_of(node, options.begin());
  const auto skipped = options.count == 0 || options.count >= kept.size()
                           ? 0
                           : kept.size() - options.count;
  for (auto i = skipped; i < kept.size(); ++i)
    out.print_event(kept[i]);
}

int show_events(const events_options& options) {
  end_quietly_on_interrupt();
  const node_client node{options.connection};
  event_printer out{options.output != "table", options.begin()};
  if (options.wants_kept())
    print_kept(options, node, out);
  if (options.no_follow)
    return exit_done;
  follow_events(node, out.last(), [&](const event& e) {
    out.print_event(e);
    return true;
  });
  throw command_error{exit_unreachable, "the node has ended the stream"};
}

} // namespace

void add_events_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<events_options>();
  auto* command = app.add_subcommand(
      "events", "Follow what happens on a node. Ctrl-C ends.");
  command->footer("Examples:\n  roscell events\n"
                  "  roscell events -n 20 --no-follow\n"
                  "  roscell events -o json | jq .event");
  add_connection_options(*command, options->connection);
  command
      ->add_option("--since", options->since,
                   "Begin after the event of this number; 0: with the oldest "
                   "that is kept. Without it only new ones are shown")
      ->check(CLI::Range(uint64_t{0}, from_now_on))
      ->option_text("NUMBER");
  command
      ->add_option("-n,--count", options->count,
                   "Begin with the last COUNT that are kept, or as many as "
                   "there are")
      ->check(CLI::Range(uint64_t{1}, from_now_on))
      ->option_text("COUNT");
  command->add_flag("--no-follow", options->no_follow,
                    "Show what is kept, and end");
  add_stream_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return show_events(*options); };
  });
}

} // namespace roscell::cli
