#pragma once

#include "actors/house.hpp"
#include "messages/type_ids.hpp"

namespace roscell {

/// Finds allocations. A search may take long, so this actor is spawned with a
/// thread of its own.
struct scheduler_state {
  static constexpr const char* name = "scheduler";

  uint64_t plans = 0;
  uint64_t refusals = 0;
};

/// The SCHEDULER. Messages: messages/coordination.hpp.
scheduler_actor::behavior_type
scheduler(scheduler_actor::stateful_pointer<scheduler_state> self);

} // namespace roscell
