#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/placement/searcher.hpp"
#include "messages/messages.hpp"

#include <functional>
#include <memory>

namespace roscell {

struct scheduler_config {
  /// Of the searches for live tasks; shared with the coordinator.
  std::shared_ptr<search_guard> guard;
  /// Spawns a SEARCHER with a thread of its own, when there is a question. It
  /// ends with its owner.
  std::function<scheduler_actor(std::shared_ptr<search_guard>,
                                const scheduler_actor& owner)>
      make_searcher;
};

/// Hands each question to one of two searchers, so that plan queries, which
/// change nothing, never hold up a task that has the placement lock.
struct scheduler_state {
  static constexpr const char* name = "scheduler";

  scheduler_config config;
  scheduler_actor live;  ///< For tasks; invalid until there was one.
  scheduler_actor trial; ///< For plan queries; invalid until there was one.
  uint64_t questions = 0;
  uint64_t trials = 0;
};

/// The SCHEDULER. Messages: messages/inside/placement.hpp.
scheduler_actor::behavior_type
scheduler(scheduler_actor::stateful_pointer<scheduler_state> self,
          const scheduler_config& config);

} // namespace roscell
