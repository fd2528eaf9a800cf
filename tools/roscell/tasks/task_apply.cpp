#include "tools/roscell/tasks/task_apply.hpp"

#include "actors/edge/io/crypto.hpp"
#include "messages/allocation_report.hpp"
#include "tools/roscell/client/progress.hpp"
#include "tools/roscell/common_options.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/tasks/set_apply.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <utility>

namespace roscell::cli {

namespace {

using clock = std::chrono::steady_clock;

/// A plan takes two searches at most.
constexpr std::chrono::seconds plan_limit{60};
/// The longest that a node may be asked to wait (messages/task.hpp).
constexpr std::chrono::milliseconds longest_wait{20'000};

/// The same request as another message.
json as_message(json request, const char* type) {
  request["type"] = type;
  for (const auto* name : {"preempt", "force", "replace", "request_id",
                           "dry_run", "keep_builds", "restart_all"})
    request.erase(name);
  return request;
}

json update_of(const apply_options& options, const json& request) {
  auto result = as_message(request, task_update::type);
  if (options.keep_builds)
    result["keep_builds"] = true;
  if (options.force)
    result["force"] = true;
  return result;
}

json ask_node(const node_client& node, const json& message,
              std::chrono::milliseconds limit) {
  return unless_refused(node.post("/v1/requests", message.dump(), limit),
                        false);
}

/// Where each step of a task that there is not yet would start.
task_update_plan plan_of_new(const apply_options& options,
                             const node_client& node, const json& request) {
  auto query = as_message(request, task_plan_query::type);
  for (const auto* name : {"timeout_s", "labels", "update"})
    query.erase(name);
  if (options.preemption.preempt)
    query["preempt"] = true;
  const auto found = ask_node(node, query, plan_limit).get<task_plan>();
  task_update_plan result;
  result.task = request.value("task", "");
  result.outcome = update_outcome::shown;
  result.warnings = found.warnings;
  for (const auto& x : found.allocations)
    result.changes.push_back({x.step,
                              step_action::starts,
                              "",
                              "",
                              x.node,
                              {"the cell does not have the task"}});
  return result;
}

void start_task(const apply_options& options, const node_client& node,
                json request, bool replace) {
  apply(options.preemption, request);
  if (replace)
    request["replace"] = true;
  add_request_id(request);
  const auto task = request.value("task", "");
  unless_refused(post_with_progress(node, request.dump(),
                                    parse_duration(options.timeout),
                                    [task](const event& e) {
                                      return progress_lines(e, task);
                                    }),
                 false);
}

command_error still_going(const task_row& row, const std::string& limit) {
  return {exit_refused,
          "task '" + printable(row.task) + "' is not updated after " + limit
              + " s: " + printable(row.updating),
          "it goes on by itself; `roscell tasks " + printable(row.task)
              + "` shows how far it is, --timeout waits longer"};
}

/// Waits for the end of an update, and tells what goes on.
void wait_until_updated(const apply_options& options, const node_client& node,
                        const task_update_plan& plan) {
  const auto& task = plan.task;
  const auto until = clock::now() + parse_duration(options.timeout);
  progress reporter{node,
                    [task](const event& e) { return progress_lines(e, task); }};
  reporter.begin();
  std::string known;
  while (true) {
    const auto now = next_change(node, task, known, until);
    if (now.tasks.empty())
      throw command_error{exit_refused,
                          "task '" + printable(task) + "' was terminated"};
    const auto& row = now.tasks.front();
    if (row.updating.empty() && row.update_problem.empty())
      return;
    if (row.updating.empty())
      throw command_error{exit_refused,
                          "task '" + printable(task) + "' is as it was before: "
                              + printable(row.update_problem),
                          "what was replaced was put back; `roscell tasks "
                              + printable(task)
                              + " --history` shows what happened"};
    if (clock::now() >= until)
      throw still_going(row, options.timeout);
    known = now.mark;
  }
}

void make_update(const apply_options& options, const node_client& node,
                 const json& update) {
  const auto plan = ask_node(node, update, parse_duration(options.timeout))
                        .get<task_update_plan>();
  if (plan.outcome == update_outcome::next_run)
    return start_task(options, node, as_message(update, task_request::type),
                      true);
  if (plan.outcome == update_outcome::begun && !options.no_wait)
    wait_until_updated(options, node, plan);
}

} // namespace

task_change next_change(const node_client& node, const std::string& task,
                        const std::string& known,
                        std::chrono::steady_clock::time_point until) {
  const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
      until - clock::now());
  task_change_query query{task, known, 0};
  query.wait_ms =
      std::clamp(left, std::chrono::milliseconds{0}, longest_wait).count();
  return ask_node(node, message_json(query), longest_wait * 2)
      .get<task_change>();
}

void add_apply_options(CLI::App& command, apply_options& options) {
  command.add_flag("--dry-run", options.dry_run,
                   "Only show what would be done; exit code 1: something "
                   "would, 2: it cannot be said");
  command.add_flag("--keep-builds", options.keep_builds,
                   "A newer build of its skill changes no step");
  command.add_flag("--no-wait", options.no_wait,
                   "Do not wait until a change is done");
}

void add_request_id(json& request) {
  constexpr size_t bytes = 16;
  if (request.count("request_id") == 0)
    request["request_id"] = "run-" + to_hex(random_bytes(bytes));
}

bool task_plan_shown::differs() const {
  if (set)
    return set->outcome != update_outcome::unchanged;
  return is_new
         || (plan.outcome != update_outcome::unchanged
             && plan.outcome != update_outcome::ended);
}

task_plan_shown plan_apply(const apply_options& options,
                           const node_client& node, const json& request) {
  task_plan_shown result;
  result.request = request;
  if (is_set(request)) {
    result.set = plan_set(options, node, request);
    result.is_new = result.set->is_new;
    return result;
  }
  auto update = update_of(options, request);
  update["dry_run"] = true;
  try {
    result.plan = ask_node(node, update, plan_limit).get<task_update_plan>();
  } catch (const refused& why) {
    if (failure_from(why.reply).code != error_code::unknown_task)
      throw;
    result.is_new = true;
    result.plan = plan_of_new(options, node, request);
  }
  return result;
}

void make_apply(const apply_options& options, const node_client& node,
                const task_plan_shown& shown) {
  if (shown.set) {
    make_set(options, node, shown.request);
    return;
  }
  if (shown.is_new || shown.plan.outcome == update_outcome::next_run)
    return start_task(options, node, shown.request, !shown.is_new);
  make_update(options, node, update_of(options, shown.request));
}

void replace_all(const apply_options& options, const node_client& node,
                 const json& request) {
  auto update = update_of(options, request);
  update["restart_all"] = true;
  make_update(options, node, update);
}

} // namespace roscell::cli
