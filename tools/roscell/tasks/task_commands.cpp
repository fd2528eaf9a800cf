#include "schemas/message_catalogue.hpp"
#include "tools/roscell/client/documents.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/set_apply.hpp"
#include "tools/roscell/tasks/task_apply.hpp"
#include "tools/roscell/tasks/wait_finished.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <memory>

namespace roscell::cli {

namespace {

struct run_options : apply_options {
  std::string file;
  file_values values;
  bool wait_finished = false;
  bool replace = false;
};

struct restart_options : task_options {
  std::string subject; ///< A task, or an instance.
};

void print_warnings(const std::vector<std::string>& warnings) {
  for (const auto& warning : warnings)
    print_note("warning: " + printable(warning));
}

/// A task of that name runs, and has another request: its steps are ended, and
/// those of the new one started. The reply is the one to the same request
/// again.
json run_in_its_place(const run_options& options, const node_client& node,
                      const task_file& file, const json& request) {
  try {
    replace_all(options, node, request);
  } catch (const refused& why) {
    throw wrong_document{file, failure_from(why.reply)};
  }
  return ask_about(options, request.value("task", ""), request);
}

/// A task of that name has another request, and runs.
bool is_taken(const json& reply) {
  return reply.value("type", "") == "error"
         && failure_from(reply).code == error_code::task_exists;
}

int run_set_file(const run_options& options, const task_file& file) {
  if (options.wait_finished)
    throw wrong_document{file,
                         {error_code::schema_violation,
                          "a set of tasks has no end to be waited for",
                          "/for_each", "leave --wait-finished out"}};
  const auto request = file.request();
  if (auto why = validate_request(request))
    throw wrong_document{file, *why};
  const node_client node{options.connection};
  try {
    const auto row = run_set(options, node, request, options.replace);
    print(options.as_json() ? pretty(json(row))
                            : "set '" + printable(row.task)
                                  + "': " + printable(set_text(row)));
  } catch (const refused& why) {
    throw wrong_document{file, failure_from(why.reply)};
  }
  return exit_done;
}

int run_task(const run_options& options) {
  const auto file = read_task_file(options.file, options.values);
  auto request = file.request();
  apply(options.preemption, request);
  if (options.replace)
    request["replace"] = true;
  if (is_set(request))
    return run_set_file(options, file);
  add_request_id(request);
  if (auto why = validate_request(request))
    throw wrong_document{file, *why};
  const auto task = request.value("task", "");
  const node_client node{options.connection};
  const auto since =
      options.wait_finished ? last_event_of_coordinator(node) : 0;
  auto reply = ask_about(options, task, request);
  if (options.replace && is_taken(reply))
    reply = run_in_its_place(options, node, file, request);
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

/// What a name stands for: a task, else an instance of one.
task_restart restart_of(const restart_options& options) {
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

int restart(const restart_options& options) {
  const auto request = restart_of(options);
  const auto reply = ask_or_throw(options, request.task, message_json(request));
  print(options.as_json()
            ? pretty(reply)
            : restarted_view(reply.get<task_restarted>(), stdout_style()));
  return exit_done;
}

void add_run(CLI::App& app, action& chosen) {
  auto options = std::make_shared<run_options>();
  auto* command = add_task_command(
      app, "run", "Start a task and wait until all of it runs.",
      "The same file again changes nothing where the task runs, starts again "
      "what has failed\nof it, waits for what is away, and starts a task that "
      "has "
      "ended once more as a whole.\nStandard error shows what goes on, and "
      "shows each place of the file that\nis wrong.\n\n"
      "Examples:\n  roscell run task.yaml\n"
      "  roscell run --set camera=arm-1 --set rate_hz=5 task.yaml\n"
      "  roscell new task echo | roscell run -",
      *options);
  command
      ->add_option("FILE", options->file,
                   "The task request; - for standard input")
      ->required()
      ->option_text(" ");
  command->add_flag("--wait-finished", options->wait_finished,
                    "Wait until the task has ended by itself; the exit code is "
                    "that of its first step that failed");
  command->add_flag("--replace", options->replace,
                    "Where a task of that name has another request, end its "
                    "steps and start these; if they have no place it goes on");
  add_value_options(*command, options->values);
  add_preemption_options(*command, options->preemption);
  command->callback([&chosen, options] {
    chosen = [options] {
      return with_marks(options->as_json(), [&] { return run_task(*options); });
    };
  });
}

void add_restart(CLI::App& app, action& chosen) {
  auto options = std::make_shared<restart_options>();
  auto* command = add_task_command(
      app, "restart",
      "End the instances of a task, or one of them, and start them again.",
      "What runs begins anew on its node, what has ended where it fits.\n\n"
      "Examples:\n  roscell restart fleet-poses\n"
      "  roscell restart fleet-poses-camera-1a2b3c4d",
      *options);
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
  add_apply_command(app, chosen);
  add_rollback_command(app, chosen);
  add_stop_command(app, chosen);
  add_restart(app, chosen);
  add_set_command(app, chosen);
}

} // namespace roscell::cli
