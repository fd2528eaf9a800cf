#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/messages.hpp"

#include <atomic>
#include <memory>
#include <mutex>
#include <set>
#include <string>

namespace roscell {

/// Ends a search whose nodes do not stay. The scheduler hears no message while
/// it searches, so the coordinator tells it through this; safe for threads.
class search_guard {
public:
  /// A search on these nodes begins.
  void begin(std::set<std::string> nodes);

  /// A node can be used no more.
  void node_left(const std::string& node);

  /// Whether a node of the search has left.
  bool must_stop() const {
    return stopped_;
  }

  /// The search is over. Returns the first of its nodes that left, or nothing.
  std::string end();

private:
  std::mutex mutex_;
  std::set<std::string> nodes_;
  std::string gone_;
  std::atomic<bool> stopped_{false};
};

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
