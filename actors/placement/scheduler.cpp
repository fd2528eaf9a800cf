#include "actors/placement/scheduler.hpp"
#include "actors/core/watching.hpp"

#include <caf/actor_cast.hpp>
#include <caf/result.hpp>

namespace roscell {

namespace {

using scheduler_self = scheduler_actor::stateful_pointer<scheduler_state>;

/// The searcher for live tasks or for plan queries. Nobody holds the placement
/// lock while a plan is made, so no node that leaves ends the search for one.
const scheduler_actor& searcher_for(scheduler_self self, bool trial) {
  auto& st = self->state;
  auto& result = trial ? st.trial : st.live;
  if (!result) {
    result = st.config.make_searcher(trial ? std::make_shared<search_guard>()
                                           : st.config.guard,
                                     caf::actor_cast<scheduler_actor>(self));
    watch_until_its_end(self, result);
  }
  return result;
}

caf::result<task_plan> hand_on(scheduler_self self,
                               const allocate_task& asked) {
  ++(asked.trial ? self->state.trials : self->state.questions);
  return self->delegate(searcher_for(self, asked.trial), asked);
}

/// A plan of moves holds nothing, as a plan query.
caf::result<moves_planned> hand_on(scheduler_self self,
                                   const plan_moves& asked) {
  ++self->state.trials;
  return self->delegate(searcher_for(self, true), asked);
}

void on_searcher_down(scheduler_self self, const caf::down_msg& down) {
  auto& st = self->state;
  for (auto* x : {&st.live, &st.trial})
    if (*x && x->address() == down.source)
      *x = nullptr;
}

} // namespace

scheduler_actor::behavior_type scheduler(scheduler_self self,
                                         const scheduler_config& config) {
  self->state.config = config;
  self->set_down_handler(
      [self](const caf::down_msg& down) { on_searcher_down(self, down); });
  return {
      [self](const state_query&) {
        return state_of({{"questions", self->state.questions},
                         {"trials", self->state.trials}});
      },
      [self](const allocate_task& asked) { return hand_on(self, asked); },
      [self](const plan_moves& asked) { return hand_on(self, asked); },
  };
}

} // namespace roscell
