#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/updates/update_run.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"

#include <memory>
#include <utility>

namespace roscell {

namespace {

constexpr auto reason_of_end = "it was ended for an update that was put back";

void on_put_back(coordinator_pointer self, const update_ptr& run,
                 const completion& started) {
  const auto& task = task_of(*run);
  auto reason = run->problem->message;
  if (!started)
    reason += "; not all of it is put back yet: " + started.error().message;
  publish_task_event(self, events::task_update_reverted, task, task,
                     {{"reason", reason}});
  end_update(self, run);
  record_ends(self, task);
  set_timer(self);
}

/// It is started anew as soon as it has a place, which is tried for a while.
void start_later(coordinator_pointer self, const std::string& task,
                 const std::string& instance) {
  record_forced_end(self, task, instance, reason_of_end,
                    [self, instance](const completion&) {
                      self->state.orders.let_go(instance, self->clock().now(),
                                                limits::task::return_of_nodes);
                      wake(self);
                    });
}

/// It has not ended yet, or nobody knows: as soon as it has it is started anew.
void start_once_ended(coordinator_pointer self, const std::string& task,
                      const std::string& instance) {
  end_as_ordered(self, task, instance, reason_of_end);
  self->state.orders.let_go(instance, self->clock().now(),
                            limits::task::return_of_nodes);
}

/// Its node is away: it is told to start it again when it registers, as all
/// that is to run there and does not.
void wait_for_node(coordinator_pointer self, const std::string& task,
                   const replaced_step& x) {
  auto& st = self->state;
  const auto& instance = x.old->instance;
  st.deployments.forget_reported(x.old_node, instance);
  drop_order(self, task, instance);
  st.deployments.heed_end(instance);
}

/// What is new has gone, and the task has its former request. What has not
/// ended yet, where its node is away or it is not stop-safe, is started anew
/// when it has.
void put_back(coordinator_pointer self, const update_ptr& run) {
  auto& st = self->state;
  const auto& task = task_of(*run);
  if (!st.tasks.is_running(task))
    return end_update(self, run);
  std::vector<std::string> ended;
  for (const auto& x : run->steps) {
    if (!x.old || !st.orders.find(x.old->instance))
      continue;
    if (!is_surely_gone(self, x.old->instance))
      start_once_ended(self, task, x.old->instance);
    else if (st.registry.find_name(x.old_node) && is_away(st, x.old_node))
      wait_for_node(self, task, x);
    else
      ended.push_back(x.old->instance);
  }
  if (ended.empty())
    return on_put_back(self, run, {});
  start_where_they_were(self, task, ended,
                        [self, run, ended](const completion& started) {
                          for (const auto& instance : ended)
                            if (started)
                              self->state.deployments.heed_end(instance);
                            else
                              start_later(self, task_of(*run), instance);
                          on_put_back(self, run, started);
                        });
}

/// In between the task may be terminated, which takes all of it along.
void forget_fresh(coordinator_pointer self, const update_ptr& run) {
  std::vector<std::string> fresh;
  for (const auto& x : run->steps)
    if (x.fresh)
      fresh.push_back(x.fresh->instance);
  pending_change change;
  change.still = &task_table::is_running;
  change.insistent = true;
  change.make = [fresh, why = run->problem->message](task_record record) {
    return with_update_reverted(std::move(record), fresh, why, unix_now_ms());
  };
  change.done = [self, run](const completion&) { put_back(self, run); };
  change_task(self, task_of(*run), std::move(change));
}

} // namespace

void undo_update(coordinator_pointer self, const update_ptr& run,
                 const failure& why) {
  auto& st = self->state;
  if (!st.tasks.is_running(task_of(*run)))
    return end_update(self, run);
  if (!st.updates.enter(run->id, update_stage::undone))
    return;
  if (!run->problem)
    run->problem = why;
  auto open = std::make_shared<size_t>(1);
  const auto finish = [self, run, open] {
    if (--*open == 0)
      forget_fresh(self, run);
  };
  const auto until = self->clock().now() + limits::task::eviction;
  for (const auto& x : run->steps)
    if (x.fresh) {
      ++*open;
      remove_instance(self, {x.fresh_node, task_of(*run), x.fresh->instance},
                      finish, run->asked.force, until);
    }
  finish();
}

} // namespace roscell
