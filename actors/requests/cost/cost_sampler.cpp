#include "actors/requests/cost/cost_sampler.hpp"

namespace roscell {

namespace {

using cost_sampler_self =
    cost_sampler_actor::stateful_pointer<cost_sampler_state>;

void take_sample(cost_sampler_self self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  st.meter->mark(now);
  ++st.samples;
  st.next.set(self, now + cost_ring::shortest_slice);
}

} // namespace

cost_sampler_actor::behavior_type
cost_sampler(cost_sampler_self self, const std::shared_ptr<cost_meter>& meter) {
  self->state.meter = meter;
  take_sample(self);
  return {
      [self](const state_query&) {
        return state_of({{"samples", self->state.samples}});
      },
      [self](caf::tick_atom, uint64_t number) {
        if (self->state.next.rings(number))
          take_sample(self);
      },
  };
}

} // namespace roscell
