#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "embedding/skills/messages.hpp"
#include "embedding/skills/skill_keeper.hpp"

#include <caf/result.hpp>
#include <caf/typed_response_promise.hpp>

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell::embedding {

struct actor_runtime_config {
  actor_context context;
  caf::actor_system* workers = nullptr; ///< Where instances live.
  std::map<std::string, actor_skill_factory> factories; ///< By operation.
  std::size_t log_bytes = 0;                            ///< Of one instance.
};

/// An instance that is an actor of this process, or was.
struct kept_skill {
  std::string container; ///< Of its present run.
  std::shared_ptr<line_ring> log;
  skill_keeper_actor keeper; ///< Null once it has ended.
  int exit_code = -1;
  /// When an instance that was to end is given up.
  std::optional<alarm::time_point> patience;
  std::vector<caf::typed_response_promise<container_stopped>> stoppers;
  std::vector<caf::typed_response_promise<container_removed>> removers;
  std::vector<log_follower> followers;
};

/// Owns the instances of actor skills. It has a thread of its own, so that what
/// the other actor system sends does not run on that one's workers. Ends with
/// its listener.
struct actor_runtime_state {
  static constexpr const char* name = "actor-runtime";

  actor_runtime_config config;
  container_listener_actor listener;
  std::shared_ptr<frame_hub> hub;
  std::map<std::string, kept_skill> skills; ///< By instance.
  uint64_t starts = 0;
  alarm timer;
};

using actor_runtime_pointer =
    actor_runtime_actor::stateful_pointer<actor_runtime_state>;

/// The ACTOR RUNTIME. Messages: messages/inside/runtime.hpp.
actor_runtime_actor::behavior_type
actor_runtime(actor_runtime_pointer self, const actor_runtime_config& config,
              container_listener_actor listener);

// INTERNAL to the actor runtime: who reads the logs of its instances.

/// Errors: unknown_task (no log of that instance), conflict (too many wait for
/// more).
caf::result<log_excerpt> read_log(actor_runtime_pointer self,
                                  const log_query& query);

/// Answers those for whom there is something, or who have waited long enough.
void serve_followers(actor_runtime_pointer self, kept_skill& x);

/// Answers all of them: nothing will follow.
void release_followers(kept_skill& x);

} // namespace roscell::embedding
