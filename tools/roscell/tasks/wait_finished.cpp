#include "tools/roscell/tasks/wait_finished.hpp"

#include "messages/node.hpp"
#include "messages/task.hpp"
#include "tools/roscell/client/watch.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/terminal.hpp"

#include "actors/edge/http/http_target.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// Follows events about a task until one of them is wanted.
template <class Predicate>
event await(const node_client& node, const std::string& task, uint64_t since,
            Predicate&& is_wanted) {
  event result;
  follow_events(node, since, [&](const event& e) {
    if (e.subject == task && is_wanted(e.what)) {
      result = e;
      return false;
    }
    for (const auto& line : progress_lines(e, task))
      print_note(line);
    return true;
  });
  if (result.what.empty())
    throw command_error{exit_unreachable, "the node has ended the stream",
                        "`roscell tasks` shows what has become of the task"};
  return result;
}

std::string duration_text(const task_row& row) {
  const auto span = row.ended_unix_ms - row.submitted_unix_ms;
  return span > 0
             ? " after " + format_number(static_cast<double>(span) / 1000, 1)
                   + " s"
             : "";
}

int exit_code_of(const task_row& row) {
  const auto failed = std::find_if(
      row.instances.begin(), row.instances.end(), [](const instance_row& x) {
        return x.state != instance_state::stopped || x.exit_code != 0;
      });
  if (failed == row.instances.end())
    return exit_done;
  print_note("step '" + printable(failed->spec.step)
             + "': " + printable(failed->reason));
  return failed->exit_code > 0 ? failed->exit_code : exit_refused;
}

task_row look_at(const node_client& node, const std::string& task) {
  const auto found =
      node.get("/v1/tasks/" + percent_encode(task)).get<task_description>();
  return found.tasks.at(0);
}

/// "step 'camera' on arm-2: waits for node 'arm-2'".
std::string awaited_step_text(const awaited_step& x) {
  return "step '" + printable(x.step) + "' on " + printable(x.node) + ": "
         + printable(x.reason);
}

} // namespace

uint64_t last_event_of_coordinator(const node_client& node) {
  if (node.get("/v1/node").get<node_description>().role
      != node_role::coordinator)
    throw command_error{exit_usage,
                        "only a coordinator hears when a task has ended",
                        "ask it with --to; `roscell status` shows its address"};
  const auto kept = kept_events_of(node);
  return kept.empty() ? 0 : kept.back().sequence;
}

int wait_until_ended(const node_client& node, const task_accepted& begun,
                     uint64_t since) {
  const auto& task = begun.task;
  const bool has_ended =
      begun.found == task_found::finished || begun.found == task_found::failed;
  if (!has_ended) {
    const auto end = await(node, task, since, [](const std::string& what) {
      return what == events::task_finished || what == events::task_failed
             || what == events::task_terminated;
    });
    if (end.what == events::task_terminated)
      throw command_error{exit_refused,
                          "task '" + printable(task) + "' was terminated", ""};
  }
  const auto row = look_at(node, task);
  print_note("task '" + printable(task) + "' " + to_string(row.state)
             + duration_text(row));
  return exit_code_of(row);
}

void wait_until_whole(const node_client& node, const task_accepted& begun,
                      std::chrono::milliseconds limit) {
  const auto until = std::chrono::steady_clock::now() + limit;
  const auto& task = begun.task;
  print_note("task '" + printable(task) + "' is there, but not all of it runs");
  for (const auto& x : begun.waits)
    print_note(awaited_step_text(x));
  change_signal changes{node};
  auto row = look_at(node, task);
  // A member hears little of other nodes, so the last look is at the end.
  for (auto news = true; row.state == task_state::degraded && news;
       row = look_at(node, task))
    news = changes.wait_until(until);
  if (row.state == task_state::degraded)
    throw command_error{
        exit_refused,
        "not all of task '" + printable(task) + "' runs after "
            + format_number(static_cast<double>(limit.count()) / 1000, 0)
            + " s",
        "it goes on by itself as soon as it can; `roscell tasks "
            + printable(task)
            + "` shows what it waits for, --timeout waits "
              "longer, and `roscell stop` ends it"};
}

void wait_until_gone(const node_client& node, const std::string& task,
                     uint64_t since) {
  await(node, task, since, [](const std::string& what) {
    return what == events::task_terminated;
  });
}

} // namespace roscell::cli
