#include "actors/edge/http/http_target.hpp"
#include "messages/instance.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

/// The coordinator asks a member, which answers at once.
constexpr std::chrono::seconds excerpt_limit{30};

struct logs_options {
  connection_options connection;
  std::string instance;
  bool follow = false;
  uint64_t tail = 0; ///< 0: all that is kept.
};

log_excerpt ask_for_log(const node_client& node, const log_query& query) {
  return node.ask(message_json(query), excerpt_limit).get<log_excerpt>();
}

/// Prints all that is kept now, part by part. What is logged meanwhile is left
/// out: a skill that logs faster than we print would keep us forever.
void print_kept(const node_client& node, const std::string& instance) {
  log_query last_line;
  last_line.instance = instance;
  last_line.tail_lines = 1;
  const auto end = ask_for_log(node, last_line).next_offset;
  log_query next;
  next.instance = instance;
  for (int64_t offset = 0; offset < end;) {
    next.offset = offset;
    const auto part = ask_for_log(node, next);
    if (part.next_offset <= offset)
      return;
    print(part.text);
    offset = part.next_offset;
  }
}

std::string stream_path(const logs_options& options) {
  auto path = "/v1/instances/" + percent_encode(options.instance) + "/logs";
  path +=
      options.tail == 0 ? "?offset=0" : "?tail=" + std::to_string(options.tail);
  return options.follow ? path + "&follow=1" : path;
}

int show_logs(const logs_options& options) {
  end_quietly_on_interrupt();
  const node_client node{options.connection};
  if (options.tail == 0 && !options.follow) {
    print_kept(node, options.instance);
    return exit_done;
  }
  node.follow(stream_path(options), [](std::string_view line) {
    print(std::string{line} + "\n");
    return true;
  });
  return exit_done;
}

} // namespace

void add_logs_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<logs_options>();
  auto* command =
      app.add_subcommand("logs", "Print the log of a skill instance.");
  command->footer("Examples:\n  roscell logs fleet-poses-camera-1a2b3c4d\n"
                  "  roscell logs -f --tail 20 fleet-poses-camera-1a2b3c4d");
  add_connection_options(*command, options->connection);
  command->add_option("INSTANCE", options->instance, "Id of the instance")
      ->required();
  command->add_flag("-f,--follow", options->follow,
                    "Go on until the instance ends. Ctrl-C ends");
  command
      ->add_option("--tail", options->tail,
                   "Only the last LINES lines, at most 64 KiB of them; "
                   "without it all that is kept")
      ->check(CLI::Range(uint64_t{1}, uint64_t{100'000}))
      ->option_text("LINES");
  command->callback([&chosen, options] {
    chosen = [options] { return show_logs(*options); };
  });
}

} // namespace roscell::cli
