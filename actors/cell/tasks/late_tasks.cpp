#include "actors/cell/tasks/late_tasks.hpp"

#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "messages/event_kinds.hpp"

#include <algorithm>
#include <sstream>
#include <string>
#include <vector>

namespace roscell {

namespace {

/// "the task's timeout_s of 90 is over".
std::string reason_of_timeout(const task_entry& task) {
  std::ostringstream result;
  result << "the task's timeout_s";
  if (const auto request = request_of(task))
    result << " of " << request->timeout_s;
  result << " is over";
  return result.str();
}

/// The node has been asked already, and will be asked again.
bool is_being_ended(const cell_coordinator_state& st, const deployment& x) {
  const auto& instance = x.spec.instance;
  const auto& waiting = st.pending.not_stop_safe;
  return st.pending.removals.has(x.node, instance)
         || std::any_of(waiting.begin(), waiting.end(), [&](const auto& wait) {
              return wait.wait.instance == instance;
            });
}

/// A node that is away cannot be asked: what is there has ended once its fence
/// has, or the node is none of the cell's any more.
bool can_be_ended(coordinator_pointer self, const deployment& x) {
  const auto& st = self->state;
  return !is_away(st, x.node) || !st.registry.find_name(x.node)
         || is_surely_gone(self, x.spec.instance);
}

/// Whoever moves it or starts it again is not disturbed.
bool is_to_be_ended(coordinator_pointer self, const deployment& x) {
  const auto& st = self->state;
  return !x.end && !x.tentative && !why_not_ordered(st, x.spec.instance)
         && !is_being_ended(st, x) && can_be_ended(self, x);
}

/// Meanwhile it may have ended by itself, which came too late; its task may be
/// terminated; or the node has not answered, and it is tried again.
void on_late_removed(coordinator_pointer self, const deployment& x) {
  const auto& st = self->state;
  const auto& instance = x.spec.instance;
  if (!st.deployments.find(instance)
      || (!is_surely_gone(self, instance) && st.registry.find_name(x.node)))
    return;
  record_forced_end(self, x.spec.task, instance,
                    reason_of_timeout(*st.tasks.find(x.spec.task)),
                    [](const completion&) {});
}

void end_late_instance(coordinator_pointer self, const deployment& x) {
  auto& st = self->state;
  st.deployments.ignore_end(x.spec.instance);
  remove_instance(self, {x.node, x.spec.task, x.spec.instance},
                  [self, x] { on_late_removed(self, x); });
}

void end_late_task(coordinator_pointer self, const std::string& task,
                   bool is_first) {
  auto& st = self->state;
  std::vector<std::string> ended;
  const auto placed = st.deployments.of_task(task);
  for (const auto& x : placed) {
    // What was preempted is not started again.
    if (st.orders.find(x.spec.instance)
        && !why_not_ordered(st, x.spec.instance))
      drop_order(self, task, x.spec.instance);
    if (!is_to_be_ended(self, x))
      continue;
    ended.push_back(x.spec.instance);
    end_late_instance(self, x);
  }
  if (is_first)
    publish_task_event(self, events::task_timed_out, task, task,
                       {{"instances", ended}});
}

} // namespace

void end_late_tasks(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& [task, is_first] :
       st.deadlines.take_due(self->clock().now()))
    if (st.tasks.is_running(task))
      end_late_task(self, task, is_first);
}

} // namespace roscell
