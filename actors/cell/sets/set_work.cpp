#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/routed_answer.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// What the set asks for, as a user would.
json request_for(const task_set_record& record, const set_step& x) {
  auto request = x.task->request;
  if (x.change.action == set_action::changes) {
    task_update update;
    update.task = request.task;
    update.pipeline = std::move(request.pipeline);
    update.timeout_s = request.timeout_s;
    update.labels = std::move(request.labels);
    update.update = request.update;
    update.set = std::move(request.set);
    return message_json(update);
  }
  request.request_id = run_id(record, x.change.task);
  request.replace = x.change.action == set_action::runs;
  return message_json(request);
}

/// Meanwhile the set may be another one, or gone: what there is to do then is
/// worked out anew.
void on_answered(coordinator_pointer self, const std::string& set,
                 const set_change& change, const std::string& problem) {
  auto& st = self->state;
  if (st.sets.end(set, change.node, problem, self->clock().now()))
    publish_task_event(self, events::set_stuck, change.task, set,
                       {{"node", change.node}, {"reason", problem}});
  wake_for_sets(self);
}

/// As one of this cell's own: it is not a user who stops it.
void stop_task(coordinator_pointer self, const std::string& set,
               const set_change& change) {
  self->request(cell_coordinator_actor{self}, limits::task::termination,
                task_termination{change.task, false})
      .then([self, set, change](
                const task_terminated&) { on_answered(self, set, change, ""); },
            [self, set, change](const caf::error& why) {
              on_answered(self, set, change, to_failure(why).message);
            });
}

void carry_out(coordinator_pointer self, const task_set_record& record,
               const set_step& step) {
  auto& st = self->state;
  st.sets.begin(record.task, step);
  if (step.change.action == set_action::stops)
    return stop_task(self, record.task, step.change);
  route_request request;
  request.text = request_for(record, step).dump();
  request.from = "the set of tasks '" + record.task + "'";
  self->request(st.router, limits::request::forwarded, std::move(request))
      .then(
          [self, set = record.task, step](const request_routed& answer) {
            const auto why = refusal_in(answer);
            on_answered(self, set, step.change,
                        why ? why->message : std::string{});
          },
          [self, set = record.task, step](const caf::error& why) {
            on_answered(self, set, step.change, to_failure(why).message);
          });
}

/// One that changes is busy from when its update begins until it ends.
size_t being_changed(const cell_coordinator_state& st, const std::string& set) {
  return static_cast<size_t>(std::count_if(
      st.tasks.entries().begin(), st.tasks.entries().end(), [&](const auto& x) {
        return st.updates.is_updating(x.first) && x.second.set == set;
      }));
}

void settle_set(coordinator_pointer self, const std::string& set) {
  auto& st = self->state;
  const auto known = *st.sets.find(set);
  const auto steps = plan_of_set(st, known);
  for (const auto& step :
       st.sets.admit(set, steps, being_changed(st, set), self->clock().now()))
    carry_out(self, known.record, step);
  const auto row = describe_set(st, set, steps);
  if (st.sets.note_counts(row))
    st.context.publish_event(events::set_changed, set,
                             {{"nodes", row.nodes},
                              {"running", row.running},
                              {"pending", row.pending}});
}

/// A coordinator that has ended in between has left tasks of a set that is
/// gone.
void end_tasks_of_no_set(coordinator_pointer self) {
  auto& st = self->state;
  std::vector<std::string> orphans;
  for (const auto& [task, entry] : st.tasks.entries())
    if (!entry.set.empty() && !st.sets.find(entry.set) && !entry.ending)
      orphans.push_back(task);
  for (const auto& task : orphans)
    self->request(cell_coordinator_actor{self}, limits::task::termination,
                  task_termination{task, false})
        .then([](const task_terminated&) {}, [](const caf::error&) {});
}

} // namespace

void settle_due_sets(coordinator_pointer self) {
  auto& st = self->state;
  // Once there is a router all is looked at anyway.
  if (!st.sets.take_due(self->clock().now()) || !st.router)
    return;
  end_tasks_of_no_set(self);
  for (const auto& set : st.sets.names())
    settle_set(self, set);
}

} // namespace roscell
