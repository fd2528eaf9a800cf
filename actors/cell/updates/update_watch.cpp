#include "actors/cell/updates/task_updates.hpp"
#include "actors/cell/updates/update_run.hpp"

namespace roscell {

namespace {

/// The row of an instance of an update says that it breaks.
bool is_broken(const instance_row& row) {
  if (row.state == instance_state::stopped)
    return row.exit_code != 0;
  return row.state == instance_state::failed
         || row.state == instance_state::backing_off
         || row.health == instance_health::unhealthy;
}

} // namespace

void watch_updated(coordinator_pointer self, const instance_row& row) {
  auto& st = self->state;
  const auto id = st.updates.watching(row.spec.instance);
  if (id == 0 || !is_broken(row))
    return;
  const auto& why = row.reason.empty() ? row.health_reason : row.reason;
  undo_update(self, st.update_runs.at(id),
              {error_code::engine_failed,
               "step '" + row.spec.step + "' does not run well: " + why});
}

void settle_due_updates(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto id : st.updates.take_settled(self->clock().now())) {
    const auto run = st.update_runs.at(id);
    std::optional<failure> problem;
    for (const auto i : wave_of(*run))
      if (run->steps[i].fresh && !problem)
        if (auto why = why_unwell(st, run->steps[i]))
          problem = step_failure(*run, i, *why);
    if (problem)
      undo_update(self, run, *problem);
    else
      open_next_wave(self, run);
  }
}

} // namespace roscell
