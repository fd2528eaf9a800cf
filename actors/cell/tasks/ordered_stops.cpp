#include "actors/cell/tasks/ordered_stops.hpp"

#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

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
