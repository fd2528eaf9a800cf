#include "messages/task_update.hpp"
#include "tools/roscell/commands.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/task_apply.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"
#include "tools/roscell/view/update_view.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <memory>

namespace roscell::cli {

namespace {

constexpr std::chrono::seconds query_limit{15};

struct rollback_options : apply_options {
  std::string task;
  int64_t to = 0; ///< 0: the one before.
};

command_error not_kept(const task_revisions& known, int64_t wanted) {
  const auto& task = known.task;
  if (known.revisions.size() < 2)
    return {exit_refused,
            "task '" + printable(task) + "' has had no other request",
            "`roscell tasks " + printable(task) + " --revisions` lists them"};
  return {exit_refused,
          "revision " + std::to_string(wanted) + " of task '" + printable(task)
              + "' is not kept; "
              + std::to_string(known.revisions.front().revision) + " to "
              + std::to_string(known.revisions.back().revision) + " are",
          "`roscell tasks " + printable(task) + " --revisions` lists them"};
}

const task_revision& wanted_of(const task_revisions& known, int64_t to) {
  const auto& all = known.revisions;
  if (to == 0 && all.size() > 1)
    return all[all.size() - 2];
  for (const auto& x : all)
    if (x.revision == to)
      return x;
  throw not_kept(known, to);
}

/// What the task was, with the builds that its steps had.
json request_of(const task_revision& x) {
  auto request = json::parse(x.request, nullptr, false);
  if (!request.is_object() || !request.contains("pipeline"))
    throw command_error{exit_refused, "that revision cannot be read any more"};
  for (auto& step : request["pipeline"]) {
    const auto build = x.builds.find(step.value("id", ""));
    if (build != x.builds.end() && !step.contains("build"))
      step["build"] = build->second;
  }
  request["type"] = task_request::type;
  return request;
}

int rollback(const rollback_options& options) {
  const node_client node{options.connection};
  const auto known =
      node.ask(message_json(task_revisions_query{options.task}), query_limit)
          .get<task_revisions>();
  const auto& wanted = wanted_of(known, options.to);
  const auto shown = plan_apply(options, node, request_of(wanted));
  if (options.as_json())
    print(pretty(message_json(shown.plan)));
  else if (shown.differs())
    print(changes_view({shown.plan}, stdout_style()));
  if (options.dry_run)
    return shown.differs() ? exit_refused : exit_done;
  if (shown.differs())
    make_apply(options, node, shown);
  print_note("task '" + printable(options.task) + "' is as in revision "
             + std::to_string(wanted.revision));
  return exit_done;
}

} // namespace

void add_rollback_command(CLI::App& app, action& chosen) {
  auto options = std::make_shared<rollback_options>();
  auto* command = add_task_command(
      app, "rollback", "Make a task what it was before its last change.",
      "With the builds that its steps had then. It is a change as any other: "
      "what does not differ\ngoes on, and it is put back where it does not run "
      "well.\n\n"
      "Examples:\n  roscell rollback fleet-poses\n"
      "  roscell rollback fleet-poses --revision 3 --dry-run",
      *options);
  add_force_option(*command, *options);
  add_apply_options(*command, *options);
  command->add_option("TASK", options->task, "Its name")
      ->required()
      ->option_text(" ");
  command
      ->add_option("--revision", options->to,
                   "Go back to this one; `roscell tasks TASK --revisions` "
                   "lists them")
      ->check(CLI::PositiveNumber)
      ->option_text("NUMBER");
  command->callback([&chosen, options] {
    chosen = [options] { return rollback(*options); };
  });
}

} // namespace roscell::cli
