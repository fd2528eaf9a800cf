#include "actors/cell/state/coordinator_timer.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/member_presence.hpp"
#include "actors/cell/tasks/pending_operations.hpp"

#include <algorithm>

namespace roscell {

void set_timer(coordinator_pointer self) {
  using time_point = std::chrono::steady_clock::time_point;
  auto& st = self->state;
  const auto balance = st.balancing > 0 ? time_point::max() : st.balance_due;
  const auto next_peer =
      st.setup.connector ? st.peers.next_due() : time_point::max();
  const auto when =
      std::min({st.registry.next_overdue(), st.transfers.next_deadline(),
                st.slots.next_deadline(), next_peer, next_proof(st),
                next_change_retry(st.pending), next_end_of_remains(st.pending),
                st.pending.removals.next_due(), st.failures.next_due(),
                st.orders.next_due(), st.deadlines.next_due(),
                next_safety_deadline(st.pending), st.drains.next_due(),
                st.rebalance.next_due(), st.updates.next_due(),
                st.sets.next_due(), st.events_due, balance});
  if (when != time_point::max())
    st.timer.set(self, when);
}

void wake(coordinator_pointer self) {
  self->send(cell_coordinator_actor{self}, caf::tick_atom_v, at_once);
}

void look_at_sets(coordinator_pointer self) {
  if (self->state.sets.size() > 0)
    wake_for_sets(self);
}

void wake_for_sets(coordinator_pointer self) {
  if (self->state.sets.hurry(self->clock().now()))
    wake(self);
}

void arm_balance(coordinator_pointer self) {
  if (!self->state.setup.rebalance)
    return;
  self->state.balance_due = self->clock().now() + limits::cell::settling;
  set_timer(self);
}

std::chrono::steady_clock::time_point
next_change_retry(const pending_operations& pending) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [task, line] : pending.lines)
    result = std::min(result, line.retry);
  return result;
}

std::chrono::steady_clock::time_point
next_end_of_remains(const pending_operations& pending) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& [task, until] : pending.remains)
    result = std::min(result, until);
  return result;
}

std::chrono::steady_clock::time_point
next_safety_deadline(const pending_operations& pending) {
  auto result = std::chrono::steady_clock::time_point::max();
  for (const auto& x : pending.not_stop_safe)
    result = std::min(result, x.until);
  return result;
}

} // namespace roscell
