#include "actors/edge/history/limits.hpp"
#include "actors/edge/io/node_time.hpp"
#include "actors/node/limits.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cstddef>
#include <deque>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

int64_t wall_now_ms() {
  return clock_ms(CLOCK_REALTIME);
}

struct events_options {
  connection_options connection;
  std::string output = "table";
  std::string since;  ///< As people write it; empty: from now on.
  uint64_t count = 0; ///< Of those that were, the last ones; 0: no bound.
  bool no_follow = false;

  /// Whether something of what was is wanted.
  bool wants_past() const {
    return no_follow || count != 0 || !since.empty();
  }

  /// Without a bound all of a week would come.
  uint64_t newest() const {
    return count == 0 && since.empty() ? limits::event::kept : count;
  }
};

/// Prints events, below a heading if people read them.
class event_printer {
public:
  event_printer(bool as_json, node_role asked)
      : as_json_{as_json}, asked_{asked} {}

  void print_event(const event& e) {
    // What repeats itself is counted for people.
    if (!as_json_ && (e.passing || is_on_the_way(e, asked_)))
      return;
    if (!as_json_ && !std::exchange(begun_, true))
      print(event_heading(stdout_style().width) + "\n");
    print(as_json_
              ? compact(message_json(e))
              : shortened_line(event_line(e, stdout_style().width)) + "\n");
  }

private:
  bool as_json_;
  node_role asked_;
  bool begun_ = false;
};

/// Calls `take` with the events that were, on the disk and in memory. Returns
/// the number of the last one, wanted or not.
template <class F>
uint64_t visit_past(const node_client& node, const event_start& from,
                    uint64_t newest, F&& take) {
  past_events_query query{from.number, from.unix_ms, newest};
  const auto take_part = [&] {
    const auto part = past_events_of(node, query);
    for (const auto& e : part)
      take(e);
    if (!part.empty())
      query = {part.back().sequence, 0, 0};
    return !part.empty();
  };
  while (from.on_disk && take_part()) {
  }
  // From the beginning: one that is only counted, and says what is true now,
  // has the number of the one before it.
  for (const auto& e : kept_events_of(node, from.number)) {
    if (!e.passing && e.sequence <= query.since)
      continue;
    query.since = std::max(query.since, e.sequence);
    if (e.time_unix_ms >= from.unix_ms)
      take(e);
  }
  return query.since;
}

/// The same, printed.
uint64_t print_past(const events_options& options, const node_client& node,
                    event_printer& out) {
  const auto from = options.since.empty()
                        ? event_start{}
                        : parse_event_start(options.since, wall_now_ms());
  const auto most = options.newest();
  std::deque<event> newest;
  const auto last = visit_past(node, from, most, [&](const event& e) {
    if (most == 0)
      return out.print_event(e);
    newest.push_back(e);
    if (newest.size() > most)
      newest.pop_front();
  });
  for (const auto& e : newest)
    out.print_event(e);
  return last;
}

/// That of the node that is asked, for which only people need to wait.
node_role role_of(const node_client& node, const events_options& options) {
  return options.output == "table"
             ? node.get("/v1/node").get<node_description>().role
             : node_role::primary;
}

int show_events(const events_options& options) {
  end_quietly_on_interrupt();
  const node_client node{options.connection};
  event_printer out{options.output != "table", role_of(node, options)};
  auto last = from_now_on;
  if (options.wants_past())
    last = print_past(options, node, out);
  if (options.no_follow)
    return exit_done;
  follow_events(node, last, [&](const event& e) {
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
  command->footer(
      "Numbers go on when the node is started again, and none is given twice; "
      "after a loss of\npower some are left out. What repeats itself without "
      "end, such as the restarts of a program\nthat crashes, is told at first "
      "and then counted (\"more\"). What an instance is only on its way\nto "
      "something is left out, and so is what the coordinator's own node says "
      "before the coordinator\ndoes; -o json has it.\n\n"
      "Examples:\n  roscell events\n  roscell events -n 20 --no-follow\n"
      "  roscell events --since 2h --no-follow\n"
      "  roscell events --since '2026-11-25 18:00' --no-follow -o json");
  add_connection_options(*command, options->connection);
  command
      ->add_option(
          "--since", options->since,
          "Begin so long ago (2h, 7d), at a moment (08:00, "
          "'2026-11-25 18:00'), after the event of a number (0: with the "
          "oldest in memory), or at the start of all that is kept. "
          "Without it only new ones are shown")
      ->check([](const std::string& text) {
        try {
          parse_event_start(text, wall_now_ms());
        } catch (const std::invalid_argument& e) {
          return std::string{e.what()};
        }
        return std::string{};
      })
      ->option_text("WHEN");
  command
      ->add_option("-n,--count", options->count,
                   "Begin with the last COUNT that are kept, or as many as "
                   "there are")
      ->check(CLI::Range(uint64_t{1}, uint64_t{limits::history::newest}))
      ->option_text("COUNT");
  command->add_flag("--no-follow", options->no_follow,
                    "Show what was, without more the last 1000, and end");
  add_stream_output_option(*command, options->output);
  command->callback([&chosen, options] {
    chosen = [options] { return show_events(*options); };
  });
}

} // namespace roscell::cli
