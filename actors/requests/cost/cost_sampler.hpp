#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/requests/cost/cost_ring.hpp"
#include "messages/messages.hpp"

#include <cstdint>
#include <memory>

namespace roscell {

using cost_sampler_actor =
    introspected_actor::extend<caf::reacts_to<caf::tick_atom, uint64_t>>;

/// Marks what the node costs, once for each of the shortest slices.
struct cost_sampler_state {
  static constexpr const char* name = "cost-sampler";

  std::shared_ptr<cost_meter> meter;
  alarm next;
  uint64_t samples = 0;
};

/// The COST SAMPLER. Nobody sends it anything: who asks what the node costs
/// asks its meter.
cost_sampler_actor::behavior_type
cost_sampler(cost_sampler_actor::stateful_pointer<cost_sampler_state> self,
             const std::shared_ptr<cost_meter>& meter);

} // namespace roscell
