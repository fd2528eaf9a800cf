#include "actors/cell/updates/update_run.hpp"

#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/core/clocks.hpp"
#include "messages/event_kinds.hpp"

#include <chrono>
#include <set>
#include <utility>

namespace roscell {

namespace {

/// All of it runs, and that is on disk. What was replaced goes, and its log.
void on_updated(coordinator_pointer self, const update_ptr& run) {
  auto& st = self->state;
  const auto task = task_of(*run);
  for (const auto& x : run->plan.former()) {
    st.deployments.heed_end(x.spec.instance);
    remove_instance(self, {x.node, task, x.spec.instance}, [] {});
  }
  publish_task_event(self, events::task_updated, task, task,
                     {{"revision", st.tasks.find(task)->revisions.revision}});
  end_update(self, run);
  record_ends(self, task);
  settle_ended(self, task);
}

/// In between a new one may break, which undoes it all, or the task be
/// terminated.
void write_update(coordinator_pointer self, const update_ptr& run) {
  auto& st = self->state;
  for (size_t i = 0; i < run->steps.size(); ++i)
    if (run->steps[i].fresh)
      if (auto why = why_unwell(st, run->steps[i]))
        return undo_update(self, run, step_failure(*run, i, *why));
  if (!st.updates.enter(run->id, update_stage::written))
    return;
  updated_task now;
  now.request = run->body;
  now.fresh = replacements_of(*run);
  for (const auto& step : run->request.pipeline)
    now.steps.push_back(step.id);
  pending_change change;
  change.still = &task_table::is_running;
  change.make = [now](task_record record) {
    return with_update_done(std::move(record), now, unix_now_ms());
  };
  change.done = [self, run](const completion& kept) {
    if (kept)
      on_updated(self, run);
    else if (self->state.tasks.is_running(task_of(*run)))
      undo_update(self, run, kept.error());
    else
      end_update(self, run);
  };
  change_task(self, task_of(*run), std::move(change));
}

} // namespace

const std::vector<size_t>& wave_of(const update_run& run) {
  return run.waves[run.wave];
}

failure step_failure(const update_run& run, size_t i, const failure& why) {
  const auto& x = run.steps[i];
  auto result = why;
  result.message = "step '" + (x.fresh ? x.fresh : x.old)->step + "' on '"
                   + (x.fresh ? x.fresh_node : x.old_node)
                   + "': " + why.message;
  return result;
}

void settle_wave(coordinator_pointer self, const update_ptr& run) {
  auto& st = self->state;
  std::set<std::string> fresh;
  for (const auto i : wave_of(*run))
    if (run->steps[i].fresh)
      fresh.insert(run->steps[i].fresh->instance);
  const std::chrono::duration<double> healthy_for{
      fresh.empty() ? 0 : run->request.update.healthy_for_s};
  st.updates.settle(
      run->id, fresh,
      self->clock().now()
          + std::chrono::duration_cast<std::chrono::milliseconds>(healthy_for));
  if (healthy_for.count() > 0)
    set_timer(self);
  else
    wake(self);
}

std::optional<failure> why_unwell(const cell_coordinator_state& st,
                                  const replaced_step& x) {
  const auto row = st.deployments.find_row(x.fresh->instance);
  const bool is_done =
      row && row->state == instance_state::stopped && row->exit_code == 0;
  if (is_done)
    return std::nullopt;
  if (!row || row->state != instance_state::running)
    return failure{error_code::engine_failed, row && !row->reason.empty()
                                                  ? row->reason
                                                  : "it does not run"};
  if (row->health == instance_health::unhealthy)
    return failure{error_code::engine_failed, row->health_reason};
  if (!is_present(st, x.fresh_node))
    return failure{error_code::unreachable, "the node misses its heartbeats"};
  return std::nullopt;
}

void open_next_wave(coordinator_pointer self, const update_ptr& run) {
  auto& st = self->state;
  if (!st.updates.has(run->id))
    return;
  if (auto why = why_too_late(st, task_of(*run)))
    return undo_update(self, run, *why);
  const auto wave = st.updates.open_wave(run->id);
  if (!wave)
    return write_update(self, run);
  run->wave = *wave;
  begin_wave(self, run);
}

void end_update(coordinator_pointer self, const update_ptr& run) {
  if (const auto lock = std::exchange(run->placement_lock, 0); lock > 0)
    release_placement_lock(self, lock);
  self->state.updates.end(run->id);
  self->state.update_runs.erase(run->id);
  look_at_sets(self);
}

} // namespace roscell
