#include "actors/edge/http/http_target.hpp"
#include "actors/requests/timed_log.hpp"
#include "messages/instance.hpp"
#include "tools/roscell/client/find_instances.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/log_lines.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <future>
#include <memory>
#include <utility>
#include <vector>

namespace roscell::cli {

namespace {

/// The coordinator asks a member, which answers at once.
constexpr std::chrono::seconds excerpt_limit{30};

struct logs_options {
  connection_options connection;
  std::string subject; ///< An instance, the beginning of its id, or a task.
  bool follow = false;
  bool times = false;
  uint64_t tail = 0; ///< 0: all that is kept.
};

log_excerpt ask_for_log(const node_client& node, const log_query& query) {
  return node.ask(message_json(query), excerpt_limit).get<log_excerpt>();
}

/// Prints the log of one instance, each line behind the name of its step where
/// there are several.
class log_printer {
public:
  log_printer(const logs_options& options, const node_client& node,
              std::string instance, const std::string& prefix)
      : options_{options}, node_{node}, instance_{std::move(instance)},
        lines_{prefix, stdout_is_terminal() ? log_reader::terminal
                                            : log_reader::program} {}

  void run() {
    if (options_.tail == 0 && !options_.follow)
      print_kept();
    else
      node_.follow(stream_path(), [this](std::string_view line) {
        print(lines_.add(std::string{line} + "\n"));
        return true;
      });
    print(lines_.finish());
  }

private:
  /// Prints all that is kept now, part by part. What is logged meanwhile is
  /// left out: a skill that logs faster than we print would keep us forever.
  void print_kept() {
    log_query last_line;
    last_line.instance = instance_;
    last_line.tail_lines = 1;
    const auto end = ask_for_log(node_, last_line).next_offset;
    timed_log timed;
    log_query next;
    next.instance = instance_;
    next.times = options_.times;
    for (int64_t offset = 0; offset < end;) {
      next.offset = offset;
      const auto part = ask_for_log(node_, next);
      if (part.next_offset <= offset)
        return;
      print(lines_.add(timed.add(part)));
      offset = part.next_offset;
    }
  }

  std::string stream_path() const {
    auto path = "/v1/instances/" + percent_encode(instance_) + "/logs";
    path += options_.tail == 0 ? "?offset=0"
                               : "?tail=" + std::to_string(options_.tail);
    path += options_.times ? "&times=1" : "";
    return options_.follow ? path + "&follow=1" : path;
  }

  const logs_options& options_;
  const node_client& node_;
  std::string instance_;
  log_lines lines_;
};

/// Follows several logs at once. Each line is printed whole, so those of
/// several instances mix by lines.
void follow_all(std::vector<log_printer>& printers) {
  std::vector<std::future<void>> ends;
  ends.reserve(printers.size());
  for (auto& printer : printers)
    ends.push_back(
        std::async(std::launch::async, [&printer] { printer.run(); }));
  for (auto& end : ends)
    end.get();
}

/// The step, padded so that the lines of all steps begin in one column.
std::string prefix_of(const instance_row& row,
                      const std::vector<instance_row>& all) {
  if (all.size() < 2)
    return {};
  size_t width = 0;
  for (const auto& x : all)
    width = std::max(width, x.spec.step.size());
  return printable(row.spec.step)
         + std::string(width - row.spec.step.size(), ' ') + " | ";
}

int show_logs(const logs_options& options) {
  end_quietly_on_interrupt();
  const node_client node{options.connection};
  const auto known = node.get("/v1/instances").get<instance_description>();
  const auto found = find_instances(known.instances, options.subject);
  std::vector<log_printer> printers;
  printers.reserve(found.size());
  for (const auto& row : found)
    printers.emplace_back(options, node, row.spec.instance,
                          prefix_of(row, found));
  if (options.follow)
    follow_all(printers);
  else
    for (auto& printer : printers)
      printer.run();
  return exit_done;
}

} // namespace

void add_logs_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<logs_options>();
  auto* command = app.add_subcommand(
      "logs", "Print the log of a skill instance, or of a whole task.");
  command->footer("The beginning of an instance's id is enough if no other one "
                  "begins so. Of a task each\nline stands behind the name of "
                  "its step. On a terminal it is without colours, and with ? "
                  "for what would steer that;\nfiles and pipes get it as it "
                  "is.\n\n"
                  "Examples:\n  roscell logs fleet-poses-camera-1a2b3c4d\n"
                  "  roscell logs -t -f --tail 20 fleet-poses");
  add_connection_options(*command, options->connection);
  command
      ->add_option("INSTANCE", options->subject,
                   "Id of the instance, or name of the task")
      ->required();
  command->add_flag("-f,--follow", options->follow,
                    "Go on until the instance ends. Ctrl-C ends");
  command->add_flag("-t,--times", options->times,
                    "Put before each line when it was logged");
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
