#include "actors/cell/tasks/placement_locks.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

void grant_next_placement_lock(coordinator_pointer self) {
  auto& pending = self->state.pending;
  while (pending.placement_lock == 0 && !pending.waiting.empty()) {
    const auto next = std::move(pending.waiting.front());
    pending.waiting.pop_front();
    pending.placement_lock = next.number;
    next.begin();
  }
}

} // namespace

void take_placement_lock(coordinator_pointer self, const caf::actor_addr& owner,
                         const std::function<void(uint64_t)>& begin) {
  auto& pending = self->state.pending;
  const auto number = ++pending.last_placement_lock;
  pending.waiting.push_back(
      {number, owner, [begin, number] { begin(number); }});
  grant_next_placement_lock(self);
}

void release_placement_lock(coordinator_pointer self, uint64_t number) {
  if (self->state.pending.placement_lock != number)
    return;
  self->state.pending.placement_lock = 0;
  grant_next_placement_lock(self);
}

void leave_line(coordinator_pointer self, const caf::actor_addr& owner) {
  auto& waiting = self->state.pending.waiting;
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                               [&](const auto& x) { return x.owner == owner; }),
                waiting.end());
}

} // namespace roscell
