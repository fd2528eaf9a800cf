#include "actors/scheduler.hpp"

#include "actors/task_allocation.hpp"

#include <utility>

namespace roscell {

namespace {

using self_pointer = scheduler_actor::stateful_pointer<scheduler_state>;

caf::result<task_plan> answer(self_pointer self, const allocate_task& asked) {
  auto outcome = allocate(asked);
  if (auto* problem = std::get_if<failure>(&outcome)) {
    ++self->state.refusals;
    return to_error(*problem);
  }
  ++self->state.plans;
  return std::get<task_plan>(std::move(outcome));
}

} // namespace

scheduler_actor::behavior_type scheduler(self_pointer self) {
  return {
      [self](const state_query&) {
        return state_of(
            {{"plans", self->state.plans}, {"refusals", self->state.refusals}});
      },
      [self](const allocate_task& asked) { return answer(self, asked); },
  };
}

} // namespace roscell
