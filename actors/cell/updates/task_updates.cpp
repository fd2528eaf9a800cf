#include "actors/cell/updates/task_updates.hpp"

#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/cell/updates/update_guard.hpp"
#include "actors/cell/updates/update_run.hpp"
#include "actors/core/clocks.hpp"
#include "actors/placement/reading/step_copies.hpp"
#include "actors/placement/reading/task_reading.hpp"
#include "messages/event_kinds.hpp"

#include <memory>
#include <utility>

namespace roscell {

namespace {

using plan_promise = caf::typed_response_promise<task_update_plan>;

task_request request_in(const task_update& asked,
                        std::vector<task_step> pipeline) {
  task_request result;
  result.task = asked.task;
  result.pipeline = std::move(pipeline);
  result.timeout_s = asked.timeout_s;
  result.labels = asked.labels;
  result.update = asked.update;
  result.set = asked.set;
  return result;
}

/// A task that has ended changes with its next run.
task_update_plan plan_of_ended(const cell_coordinator_state& st,
                               const update_run& run, const task_entry& entry) {
  const bool differs = entry.request != run.body || run.asked.restart_all;
  return report_of(st, run,
                   differs ? update_outcome::next_run : update_outcome::ended);
}

/// It has come to nothing before anything was done.
void refuse(coordinator_pointer self, const update_ptr& run,
            plan_promise promise, const failure& why) {
  end_update(self, run);
  promise.deliver(to_error(why));
}

void publish_begun(coordinator_pointer self, const task_update_plan& plan) {
  json changes = json::object();
  for (const auto& x : plan.changes)
    if (x.action != step_action::stays)
      changes[x.step] = to_word(x.action);
  publish_task_event(self, events::task_update_begun, plan.task, plan.task,
                     {{"revision", plan.revision}, {"steps", changes}});
}

/// The room is held in the tables from here on, so the placement lock is
/// released.
void begin_waves(coordinator_pointer self, const update_ptr& run,
                 plan_promise promise) {
  auto& st = self->state;
  if (!st.updates.has(run->id))
    return refuse(self, run, promise,
                  to_failure(terminated_meanwhile(task_of(*run))));
  release_placement_lock(self, std::exchange(run->placement_lock, 0));
  auto plan = report_of(st, *run, update_outcome::begun);
  publish_begun(self, plan);
  st.updates.plan(run->id, plan, run->waves.size());
  promise.deliver(std::move(plan));
  open_next_wave(self, run);
}

/// What is new is written down beside what runs: a coordinator that ends from
/// here on puts it back when it starts.
void write_plan(coordinator_pointer self, const update_ptr& run,
                plan_promise promise) {
  pending_change change;
  change.still = &task_table::is_running;
  change.make = [fresh = replacements_of(*run)](task_record record) {
    return with_update_begun(std::move(record), fresh, unix_now_ms());
  };
  change.done = [self, run, promise](const completion& kept) {
    if (kept)
      begin_waves(self, run, promise);
    else
      refuse(self, run, promise, kept.error());
  };
  change_task(self, task_of(*run), std::move(change));
}

/// Somebody else has changed it meanwhile.
void answer_unchanged(coordinator_pointer self, const update_ptr& run,
                      plan_promise promise) {
  end_update(self, run);
  promise.deliver(report_of(self->state, *run, update_outcome::unchanged));
}

/// It was planned before the lock was there, and is planned once more: what
/// runs may have changed.
void plan_under_lock(coordinator_pointer self, const update_ptr& run,
                     const plan_promise& promise) {
  if (auto why = plan_changes(self, *run))
    return refuse(self, run, promise, *why);
  if (run->plan.is_empty())
    return answer_unchanged(self, run, promise);
  place_update(self, run, [self, run, promise](const completion& placed) {
    if (!placed)
      return refuse(self, run, promise, placed.error());
    if (auto why = why_busy(self->state, task_of(*run)))
      return refuse(self, run, promise, *why);
    if (!self->state.failures.has_room(run->steps.size()))
      return refuse(self, run, promise,
                    {error_code::conflict, "the cell runs too many instances",
                     "/pipeline", "send it again when some have ended"});
    write_plan(self, run, promise);
  });
}

void begin_update(coordinator_pointer self, const update_ptr& run,
                  const plan_promise& promise) {
  auto& st = self->state;
  run->id = st.updates.begin(task_of(*run), run->body);
  st.update_runs[run->id] = run;
  take_placement_lock(self, caf::actor_addr{},
                      [self, run, promise](uint64_t placement_lock) {
                        run->placement_lock = placement_lock;
                        plan_under_lock(self, run, promise);
                      });
}

void show_update(coordinator_pointer self, const update_ptr& run,
                 plan_promise promise) {
  place_update(
      self, run, [self, run, promise](const completion& placed) mutable {
        if (placed)
          promise.deliver(report_of(self->state, *run, update_outcome::shown));
        else
          promise.deliver(to_error(placed.error()));
      });
}

} // namespace

caf::result<task_update_plan> update_task(coordinator_pointer self,
                                          const task_update& request) {
  auto& st = self->state;
  const auto* entry = st.tasks.find(request.task);
  if (!entry)
    return unknown_thing("task", request.task);
  auto steps = with_copies(request.pipeline);
  if (auto* why = std::get_if<failure>(&steps))
    return to_error(*why);
  auto run = std::make_shared<update_run>();
  run->asked = request;
  run->request =
      request_in(request, std::get<std::vector<task_step>>(std::move(steps)));
  run->body = body_of(run->request);
  // The same once more hears the same.
  if (const auto* known = st.updates.find_plan(request.task, run->body))
    return *known;
  if (auto why = why_updating(st, request.task); why && !request.dry_run)
    return to_error(*why);
  if (auto why = why_kept_by_set(st, request.task, run->body))
    return to_error(*why);
  if (is_settled(entry->state) && !entry->ending)
    return plan_of_ended(st, *run, *entry);
  if (auto why = plan_changes(self, *run))
    return to_error(*why);
  if (run->plan.is_empty())
    return report_of(st, *run, update_outcome::unchanged);
  auto promise = self->make_response_promise<task_update_plan>();
  if (request.dry_run)
    show_update(self, run, promise);
  else
    begin_update(self, run, promise);
  return promise;
}

caf::result<task_revisions> list_revisions(coordinator_pointer self,
                                           const task_revisions_query& query) {
  const auto& st = self->state;
  const auto* entry = st.tasks.find(query.task);
  if (!entry)
    return unknown_thing("task", query.task);
  return task_revisions{query.task,
                        revisions_of(query.task, *entry, st.deployments)};
}

} // namespace roscell
