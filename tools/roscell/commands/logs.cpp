#include "messages/instance.hpp"
#include "messages/kept_log.hpp"
#include "tools/roscell/client/find_things.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/commands/log_printer.hpp"
#include "tools/roscell/common_options.hpp"
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

struct logs_options {
  connection_options connection;
  std::string subject;   ///< An instance, the beginning of its id, or a task.
  bool previous = false; ///< Of an earlier run.
  log_request request;
  std::string output = "table";
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
std::string prefix_of(const std::string& step,
                      const std::vector<std::string>& all) {
  if (all.size() < 2)
    return {};
  size_t width = 0;
  for (const auto& x : all)
    width = std::max(width, x.size());
  return printable(step) + std::string(width - step.size(), ' ') + " | ";
}

kept_logs ask_for_kept(const node_client& node) {
  return node.ask(message_json(kept_logs_query{}), log_limit).get<kept_logs>();
}

int list_kept(const logs_options& options, const node_client& node) {
  const auto logs = ask_for_kept(node);
  const json document = message_json(logs);
  print(options.output == "json" ? pretty(document)
                                 : kept_logs_view(logs, view_style_now()));
  return exit_done;
}

int print_found(const logs_options& options, const node_client& node,
                const std::vector<kept_log>& found) {
  std::vector<std::string> steps;
  steps.reserve(found.size());
  for (const auto& log : found)
    steps.push_back(log.step);
  for (const auto& log : found) {
    print_note(kept_log_text(log, view_style_now().now_unix_ms));
    log_query subject;
    subject.instance = log.instance;
    subject.node = log.node;
    subject.previous = true;
    log_printer{options.request, node, subject, prefix_of(log.step, steps)}
        .run();
  }
  return exit_done;
}

int show_previous(const logs_options& options, const node_client& node) {
  const auto kept = ask_for_kept(node);
  const auto found = find_kept_logs(kept.logs, options.subject);
  if (!found.empty())
    return print_found(options, node, found);
  throw command_error{exit_refused,
                      "no log of an instance or a task '" + options.subject
                          + "' that is gone is kept",
                      kept.silent.empty()
                          ? "`roscell logs --previous` lists what is kept"
                          : "without those of " + joined(kept.silent, ", ")};
}

/// Those that are there, or none if what is meant is gone and its log is kept.
/// What a member does not have its coordinator may know.
std::vector<instance_row> find_present(const logs_options& options,
                                       const node_client& node,
                                       std::vector<kept_log>& gone) {
  const auto known = node.get("/v1/instances").get<instance_description>();
  try {
    return find_instances(known.instances, options.subject);
  } catch (const command_error& why) {
    if (why.code != exit_refused)
      throw;
    gone = find_kept_logs(ask_for_kept(node).logs, options.subject);
    if (!gone.empty())
      return {};
    const auto elsewhere = instances_in_cell(node);
    if (elsewhere.empty())
      throw;
    return find_instances(elsewhere, options.subject);
  }
}

int show_logs(const logs_options& options) {
  end_quietly_on_interrupt();
  const node_client node{options.connection};
  if (options.subject.empty() && options.previous)
    return list_kept(options, node);
  if (options.previous)
    return show_previous(options, node);
  std::vector<kept_log> gone;
  const auto found = find_present(options, node, gone);
  if (!gone.empty())
    return print_found(options, node, gone);
  std::vector<std::string> steps;
  steps.reserve(found.size());
  for (const auto& row : found)
    steps.push_back(row.spec.step);
  std::vector<log_printer> printers;
  printers.reserve(found.size());
  for (const auto& row : found) {
    log_query subject;
    subject.instance = row.spec.instance;
    printers.emplace_back(options.request, node, subject,
                          prefix_of(row.spec.step, steps));
  }
  if (options.request.follow)
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
                  "is. Of what has been stopped the log is kept for some days, "
                  "and standard error\ntells how it ended.\n\n"
                  "Examples:\n  roscell logs fleet-poses-camera-1a2b3c4d\n"
                  "  roscell logs -t -f --tail 20 fleet-poses\n"
                  "  roscell logs --previous");
  add_connection_options(*command, options->connection);
  command->add_option("INSTANCE", options->subject,
                      "Id of the instance, or name of the task");
  command->add_flag("-f,--follow", options->request.follow,
                    "Go on until the instance ends. Ctrl-C ends");
  command->add_flag("-p,--previous", options->previous,
                    "The log that was kept of an earlier run, or of an "
                    "instance that is gone; without INSTANCE\nlist these");
  command->add_flag("-t,--times", options->request.times,
                    "Put before each line when it was logged");
  command
      ->add_option("--tail", options->request.tail,
                   "Only the last LINES lines, at most 64 KiB of them; "
                   "without it all that is kept")
      ->check(CLI::Range(uint64_t{1}, uint64_t{100'000}))
      ->option_text("LINES");
  add_output_option(*command, options->output);
  command->callback([&chosen, options] {
    if (options->subject.empty() && !options->previous)
      throw CLI::RequiredError{"INSTANCE"};
    chosen = [options] { return show_logs(*options); };
  });
}

} // namespace roscell::cli
