#include "actors/cell/state/coordinator_timer.hpp"

#include "actors/cell/state/arrivals.hpp"
#include "actors/cell/state/doubts.hpp"
#include "actors/house/limits.hpp"

#include <algorithm>

namespace roscell {

namespace {

using time_point = std::chrono::steady_clock::time_point;

time_point next_transfer_deadline(const cell_coordinator_state& st) {
  auto result = time_point::max();
  for (const auto& [id, x] : st.transfers)
    result = std::min(result, x.deadline);
  return result;
}

} // namespace

void set_timer(coordinator_pointer self) {
  auto& st = self->state;
  const auto balance = st.balancing > 0 ? time_point::max() : st.balance_due;
  const auto next_peer =
      st.setup.connector ? st.peers.next_due() : time_point::max();
  const auto when =
      std::min({st.registry.next_overdue(), next_transfer_deadline(st),
                next_arrival_deadline(st), next_peer, next_proof(st), balance});
  if (when != time_point::max())
    st.timer.set(self, when);
}

void arm_balance(coordinator_pointer self) {
  if (!self->state.setup.rebalance)
    return;
  self->state.balance_due = self->clock().now() + limits::cell::settling;
  set_timer(self);
}

} // namespace roscell
