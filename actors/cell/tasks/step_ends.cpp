#include "actors/cell/tasks/step_ends.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/core/clocks.hpp"
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

namespace {

void on_stopped(coordinator_pointer self, const ordered_stop& stop) {
  const auto& instance = stop.order.instance;
  if (is_surely_gone(self, instance))
    return stop.done(stop_outcome::ended, {});
  const failure why{error_code::conflict, "it is unknown whether '" + instance
                                              + "' on node '" + stop.node
                                              + "' has ended"};
  const auto* placed = self->state.deployments.find(instance);
  const auto step = placed ? "/" + placed->spec.step : "";
  const failure late{error_code::timeout,
                     "'" + stop.task + step + "' on node '" + stop.node
                         + "' is not stop-safe yet, or does not end",
                     "", "`roscell tasks` shows what is waited for"};
  const bool waits = !is_away(self->state, stop.node);
  stop.done(stop_outcome::failed, waits ? late : why);
}

void on_order_persisted(coordinator_pointer self, const ordered_stop& stop) {
  auto& st = self->state;
  const auto& instance = stop.order.instance;
  const auto* placed = st.deployments.find(instance, stop.node);
  const bool is_over = !placed || placed->end || has_ordered_end(st, *placed);
  if (is_over || (stop.still && !stop.still())) {
    drop_order(self, stop.task, instance);
    return stop.done(stop_outcome::had_ended, {});
  }
  if (const auto why = why_not_ordered(st, instance))
    return stop.done(stop_outcome::failed, *why);
  st.orders.add(stop.task, stop.order);
  st.orders.ask(instance);
  if (stop.has_successor)
    st.deployments.ignore_end(instance);
  if (stop.asked)
    stop.asked();
  remove_instance(
      self, {stop.node, stop.task, instance},
      [self, stop] { on_stopped(self, stop); }, stop.force, stop.until);
}

/// Its node has come back with it meanwhile, and nobody asks to end it any
/// more.
bool runs_on(const cell_coordinator_state& st, const std::string& instance) {
  const auto* placed = st.deployments.find(instance);
  if (!placed || is_away(st, placed->node)
      || st.pending.removals.has(placed->node, instance))
    return false;
  const auto& not_stop_safe = st.pending.not_stop_safe;
  const auto waits = [&](const auto& x) { return x.wait.instance == instance; };
  const auto* row = st.deployments.reported(placed->node, instance);
  return row && is_live(row->state) && row->unsafe_since_unix_ms == 0
         && std::none_of(not_stop_safe.begin(), not_stop_safe.end(), waits);
}

} // namespace

void stop_by_order(coordinator_pointer self, const ordered_stop& stop) {
  if (const auto why = why_not_ordered(self->state, stop.order.instance))
    return stop.done(stop_outcome::failed, *why);
  pending_change change;
  change.still = &task_table::is_kept;
  change.make = [order = stop.order](task_record record) {
    return with_order(std::move(record), order);
  };
  change.done = [self, stop](const completion& kept) {
    if (kept)
      on_order_persisted(self, stop);
    else if (self->state.tasks.is_kept(stop.task))
      stop.done(stop_outcome::failed, kept);
    else
      stop.done(stop_outcome::had_ended, {});
  };
  change_task(self, stop.task, std::move(change));
}

void end_as_ordered(coordinator_pointer self, const std::string& task,
                    const std::string& instance, const std::string& reason) {
  auto& st = self->state;
  if (!st.orders.find(instance))
    return st.deployments.heed_end(instance);
  // What its fence has ended is to be placed anew: it has not failed.
  if (is_surely_gone(self, instance) && !st.failures.find_abandoned(instance)) {
    record_forced_end(self, task, instance, reason, [](const completion&) {});
    return drop_order(self, task, instance);
  }
  st.orders.let_go(instance, self->clock().now());
  st.deployments.heed_end(instance);
  record_ends(self, task);
  if (runs_on(st, instance))
    drop_order(self, task, instance);
}

void drop_order(coordinator_pointer self, const std::string& task,
                const std::string& instance) {
  self->state.orders.forget(instance);
  pending_change change;
  change.still = &task_table::is_kept;
  change.insistent = true;
  change.make = [instance](task_record record) {
    return without_order(std::move(record), instance);
  };
  change_task(self, task, std::move(change));
}

std::optional<failure> why_not_ordered(const cell_coordinator_state& st,
                                       const std::string& instance) {
  const auto* known = st.orders.find(instance);
  if (!known || !known->held)
    return std::nullopt;
  return failure{error_code::conflict,
                 "'" + instance + "' is told to end already", "/instance",
                 "send it again in a while"};
}

bool has_ordered_end(const cell_coordinator_state& st, const deployment& x) {
  const auto* row = st.deployments.reported(x.node, x.spec.instance);
  return row && !is_live(row->state);
}

} // namespace roscell
