#include "actors/cell/tasks/task_turns.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

void begin_next_turn(coordinator_pointer self) {
  auto& desk = self->state.desk;
  while (desk.turn == 0 && !desk.waiting.empty()) {
    const auto next = std::move(desk.waiting.front());
    desk.waiting.pop_front();
    desk.turn = next.number;
    next.begin();
  }
}

} // namespace

void take_turn(coordinator_pointer self, const caf::actor_addr& owner,
               const std::function<void(uint64_t)>& begin) {
  auto& desk = self->state.desk;
  const auto number = ++desk.last_turn;
  desk.waiting.push_back({number, owner, [begin, number] { begin(number); }});
  begin_next_turn(self);
}

void end_turn(coordinator_pointer self, uint64_t number) {
  if (self->state.desk.turn != number)
    return;
  self->state.desk.turn = 0;
  begin_next_turn(self);
}

void leave_line(coordinator_pointer self, const caf::actor_addr& owner) {
  auto& waiting = self->state.desk.waiting;
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                               [&](const auto& x) { return x.owner == owner; }),
                waiting.end());
}

} // namespace roscell
