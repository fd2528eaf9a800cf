#pragma once

#include "actors/house/house.hpp"
#include "actors/placement/search_guard.hpp"
#include "messages/messages.hpp"

#include <memory>

namespace roscell {

/// Finds allocations. A search may take long, so this actor is spawned with a
/// thread of its own.
struct scheduler_state {
  static constexpr const char* name = "scheduler";

  std::shared_ptr<search_guard> guard;
  uint64_t plans = 0;
  uint64_t refusals = 0;
  uint64_t interrupted = 0; ///< Searches whose nodes did not stay.
};

/// The SCHEDULER. Messages: messages/coordination.hpp. `guard` is shared with
/// the coordinator.
scheduler_actor::behavior_type
scheduler(scheduler_actor::stateful_pointer<scheduler_state> self,
          std::shared_ptr<search_guard> guard);

} // namespace roscell
