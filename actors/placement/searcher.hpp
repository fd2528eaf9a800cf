#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/placement/search_guard.hpp"
#include "messages/messages.hpp"

#include <memory>

namespace roscell {

/// Finds allocations, one after the other. A search may take long, so this
/// actor is spawned with a thread of its own.
struct searcher_state {
  static constexpr const char* name = "searcher";

  actor_context context;
  std::shared_ptr<search_guard> guard;
  uint64_t plans = 0;
  uint64_t move_plans = 0;
  uint64_t refusals = 0;
  uint64_t interrupted = 0; ///< Searches whose nodes did not stay.
};

/// The SEARCHER, behind the SCHEDULER and with its handle. Messages:
/// messages/inside/placement.hpp. `guard` tells it of nodes that leave. Ends
/// with its owner.
scheduler_actor::behavior_type
searcher(scheduler_actor::stateful_pointer<searcher_state> self,
         const actor_context& context, std::shared_ptr<search_guard> guard,
         const scheduler_actor& owner);

} // namespace roscell
