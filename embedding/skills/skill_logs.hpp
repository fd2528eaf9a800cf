#pragma once

#include "embedding/skills/actor_runtime.hpp"

#include <caf/result.hpp>

/// INTERNAL to the actor runtime: who reads the logs of its instances.
namespace roscell::embedding {

/// Errors: unknown_task (no log of that instance), conflict (too many wait for
/// more).
caf::result<log_excerpt> read_log(actor_runtime_pointer self,
                                  const log_query& query);

/// Answers those for whom there is something, or who have waited long enough.
void serve_followers(actor_runtime_pointer self, kept_skill& x);

/// Answers all of them: nothing will follow.
void release_followers(kept_skill& x);

} // namespace roscell::embedding
