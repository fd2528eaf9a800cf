#include "actors/edge/io/crypto.hpp"
#include "schemas/message_catalogue.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/preemption.hpp"
#include "tools/roscell/tasks/wait_finished.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct task_options {
  connection_options connection;
  std::string output = "table";
  std::string timeout = "120";
  std::string subject; ///< A file, a task, or an instance.
  bool wait_finished = false;
  bool force = false;
  preemption_options preemption;

  bool as_json() const {
    return output == "json";
  }
};

using options_ptr = std::shared_ptr<task_options>;

/// Sends a request about a task and tells what goes on until it is answered.
json ask_about(const task_options& options, const std::string& task,
               const json& request) {
  const node_client node{options.connection};
  const auto lines = [task](const event& e) { return progress_lines(e, task); };
  return post_with_progress(node, request.dump(),
                            parse_duration(options.timeout), lines);
}

/// The same where a refusal has no document to point into.
json ask_or_throw(const task_options& options, const std::string& task,
                  const json& request) {
  return unless_refused(ask_about(options, task, request), options.as_json());
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const auto& warning : warnings)
    print_note("warning: " + printable(warning));
}

/// Somebody who types the command wants the task to run: once more, where it
/// has ended. Programs that may have to repeat themselves say an id of theirs.
void add_request_id(json& request) {
  constexpr size_t bytes = 16;
  if (request.count("request_id") == 0)
    request["request_id"] = "run-" + to_hex(random_bytes(bytes));
}

int run_task(const task_options& options) {
  const auto file = read_task_file(options.subject);
  auto request = file.request();
  apply(options.preemption, request);
  add_request_id(request);
  if (auto why = validate_request(request))
    throw wrong_document{file, *why};
  const auto task = request.value("task", "");
  const node_client node{options.connection};
  const auto since =
      options.wait_finished ? last_event_of_coordinator(node) : 0;
  const auto reply = ask_about(options, task, request);
  if (reply.value("type", "") == "error")
    throw wrong_document{file, failure_from(reply)};
  const auto accepted = reply.get<task_accepted>();
  print(options.as_json() ? pretty(reply)
                          : accepted_view(accepted, stdout_style()));
  if (!options.as_json())
    print_warnings(accepted.warnings);
  if (options.wait_finished)
    return wait_until_ended(node, accepted, since);
  if (accepted.found == task_found::degraded)
    wait_until_whole(node, accepted, parse_duration(options.timeout));
  return exit_done;
}

/// What is not stop-safe yet is waited for, unless a program has asked.
int stop_task(const task_options& options) {
  const node_client node{options.connection};
  const auto& task = options.subject;
  const auto ask = [&] {
    return ask_or_throw(options, task,
                        message_json(task_termination{task, options.force}));
  };
  const auto kept = kept_events_of(node);
  auto reply = ask();
  auto reported = reply.get<task_terminated>();
  if (!reported.waiting.empty() && !options.as_json()) {
    for (const auto& x : reported.waiting)
      print_note(waiting_text(x));
    wait_until_gone(node, task, kept.empty() ? 0 : kept.back().sequence);
    reported = ask().get<task_terminated>();
  }
  print(options.as_json() ? pretty(reply) : terminated_view(reported));
  return exit_done;
}

/// What a name stands for: a task, else an instance of one.
task_restart restart_of(const task_options& options) {
  const node_client node{options.connection};
  const auto tasks = node.get("/v1/tasks").get<task_description>();
  for (const auto& task : tasks.tasks) {
    if (task.task == options.subject)
      return {task.task, "", options.force};
    for (const auto& x : task.instances)
      if (x.spec.instance == options.subject)
        return {task.task, options.subject, options.force};
  }
  throw command_error{exit_refused,
                      "no task and no instance is named '"
                          + printable(options.subject) + "'",
                      "`roscell tasks` and `roscell instances` list them"};
}

int restart(const task_options& options) {
  const auto request = restart_of(options);
  const auto reply = ask_or_throw(options, request.task, message_json(request));
  print(options.as_json()
            ? pretty(reply)
            : restarted_view(reply.get<task_restarted>(), stdout_style()));
  return exit_done;
}

CLI::App* add_task_command(CLI::App& app, const char* name,
                           const char* description, const char* footer,
                           const options_ptr& options) {
  auto* command = app.add_subcommand(name, description);
  command->footer(footer);
  add_connection_options(*command, options->connection);
  add_timeout_option(*command, options->timeout);
  add_output_option(*command, options->output);
  return command;
}

void add_force_option(CLI::App& command, task_options& options) {
  command.add_flag("--force", options.force,
                   "Do not wait for what is not stop-safe");
}

void add_run(CLI::App& app, action& chosen) {
  auto options = std::make_shared<task_options>();
  auto* command = add_task_command(
      app, "run", "Start a task and wait until all of it runs.",
      "The same file again changes nothing where the task runs, starts again "
      "what has failed\nof it, waits for what is away, and starts a task that "
      "has "
      "ended once more as a whole.\nStandard error shows what goes on, and "
      "shows each place of the file that\nis wrong.\n\n"
      "Examples:\n  roscell run task.yaml\n"
      "  roscell new task echo | roscell run -",
      options);
  command
      ->add_option("FILE", options->subject,
                   "The task request; - for standard input")
      ->required()
      ->option_text(" ");
  command->add_flag("--wait-finished", options->wait_finished,
                    "Wait until the task has ended by itself; the exit code is "
                    "that of its first step that failed");
  add_preemption_options(*command, options->preemption);
  command->callback([&chosen, options] {
    chosen = [options] {
      return with_marks(options->as_json(), [&] { return run_task(*options); });
    };
  });
}

void add_stop(CLI::App& app, action& chosen) {
  auto options = std::make_shared<task_options>();
  auto* command = add_task_command(
      app, "stop", "End a task and remove its instances everywhere.",
      "What has to be stop-safe before it ends is waited for. Ctrl-C ends the "
      "waiting only.\n\n"
      "Examples:\n  roscell stop fleet-poses\n"
      "  roscell stop fleet-poses --force",
      options);
  add_force_option(*command, *options);
  command->add_option("TASK", options->subject, "Its name")
      ->required()
      ->option_text(" ");
  command->callback([&chosen, options] {
    chosen = [options] { return stop_task(*options); };
  });
}

void add_restart(CLI::App& app, action& chosen) {
  auto options = std::make_shared<task_options>();
  auto* command = add_task_command(
      app, "restart",
      "End the instances of a task, or one of them, and start them again.",
      "What runs begins anew on its node, what has ended where it fits.\n\n"
      "Examples:\n  roscell restart fleet-poses\n"
      "  roscell restart fleet-poses-camera-1a2b3c4d",
      options);
  add_force_option(*command, *options);
  command->add_option("TASK|INSTANCE", options->subject, "The name of either")
      ->required()
      ->option_text(" ");
  command->callback(
      [&chosen, options] { chosen = [options] { return restart(*options); }; });
}

} // namespace

void add_task_commands(CLI::App& app, action& chosen) {
  add_run(app, chosen);
  add_stop(app, chosen);
  add_restart(app, chosen);
}

} // namespace roscell::cli
