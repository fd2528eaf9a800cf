#pragma once

#include "actors/instances/process/process_runtime.hpp"

/// INTERNAL to the process runtime: reading and following logs.
namespace roscell {

using process_runtime_pointer =
    process_runtime_actor::stateful_pointer<process_runtime_state>;

/// Answers now, or when there is something to say.
caf::result<log_excerpt> read_log(process_runtime_pointer self,
                                  const log_query& query);

/// Checks whether the followers of an instance's log can be answered.
void serve_followers(process_runtime_pointer self, const std::string& instance);

/// Answers the followers whose time is over, and sets the alarm for the others.
void release_followers(process_runtime_pointer self);

} // namespace roscell
