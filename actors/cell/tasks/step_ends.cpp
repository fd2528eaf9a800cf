#include "actors/cell/tasks/step_ends.hpp"

#include "actors/cell/state/task_story.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/core/wall_clock.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// Ends that are still to be written are taken up with those before them.
bool has_waiting_ends(const cell_coordinator_state& st,
                      const std::string& task) {
  const auto line = st.pending.lines.find(task);
  return line != st.pending.lines.end()
         && std::any_of(line->second.changes.begin(),
                        line->second.changes.end(),
                        [](const auto& x) { return x.takes_ends; });
}

/// The ends that nodes have told of. What was told to end has not done its
/// work, whatever its exit code.
std::vector<instance_end> ends_of(const cell_coordinator_state& st,
                                  const std::string& task) {
  auto result = st.deployments.untaken_ends(task);
  for (auto& x : result)
    if (st.orders.is_asked(x.instance)) {
      x.state = instance_state::failed;
      x.exit_code = -1;
      x.reason = st.orders.find(x.instance)->order.reason;
    }
  return result;
}

} // namespace

void record_ends(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  if (!st.tasks.is_running(task) || st.deployments.untaken_ends(task).empty()
      || has_waiting_ends(st, task))
    return;
  pending_change change;
  change.still = &task_table::is_running;
  change.insistent = true;
  change.takes_ends = true;
  change.make = [self, task](task_record record) {
    return with_ends(std::move(record), ends_of(self->state, task),
                     unix_now_ms());
  };
  change.done = [self, task](const completion& kept) {
    if (!kept)
      return;
    record_ends(self, task);
    settle_ended(self, task);
  };
  change_task(self, task, std::move(change));
}

void record_forced_end(coordinator_pointer self, const std::string& task,
                       const std::string& instance, const std::string& reason,
                       const completion_handler& done) {
  const instance_end end{instance, instance_state::failed, -1, reason,
                         unix_now_ms()};
  pending_change change;
  change.still = &task_table::is_running;
  change.insistent = true;
  change.make = [end](task_record record) {
    return with_ends(std::move(record), {end}, end.unix_ms);
  };
  change.done = [self, task, instance, done](const completion& kept) {
    self->state.deployments.heed_end(instance);
    if (kept)
      settle_ended(self, task);
    done(kept);
  };
  change_task(self, task, std::move(change));
}

void settle_ended(coordinator_pointer self, const std::string& task) {
  auto& st = self->state;
  const auto* entry = st.tasks.find(task);
  if (!entry || entry->ending || !is_settled(entry->state))
    return;
  json data = json::object();
  for (const auto& x : st.deployments.of_task(task))
    if (x.end && x.end->exit_code != 0)
      data["reason"] = "step '" + x.spec.step + "': " + x.end->reason;
  if (const auto span = entry->ended_unix_ms - entry->submitted_unix_ms;
      span > 0)
    data["duration_s"] = static_cast<double>(span) / 1000;
  publish_task_event(self,
                     entry->state == task_state::finished
                         ? events::task_finished
                         : events::task_failed,
                     task, task, data);
  for (const auto& old : st.tasks.superfluous())
    end_settled(self, old);
}

} // namespace roscell
