#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/instances/life/any_runtime.hpp"
#include "actors/instances/process/process_instance.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// How far the ending of a program has gone.
enum class ending { none, asked, killed, shim_killed };

/// One instance of the process runtime.
struct running_process {
  process_instance process;
  child_watch watch;
  bool fence_fails = false; ///< Its fence could not be moved on.
  ending stage = ending::none;
  /// When the next stage begins.
  std::optional<alarm::time_point> next_stage;
  std::vector<caf::typed_response_promise<container_stopped>> stoppers;
  std::vector<caf::typed_response_promise<container_removed>> removers;
  bool goes_on = false;        ///< Its log does: it is started again.
  std::vector<kept_log> about; ///< What its log is kept with.
};

struct followed_log {
  fd_watch watch;
  std::vector<log_follower> followers;
};

/// Owns the shims of the process instances. Spawned as one that
/// blocks: it waits for processes and the disk. Ends with its listener.
struct process_runtime_state {
  static constexpr const char* name = "process-runtime";

  process_runtime_config config;
  container_listener_actor listener;
  std::map<std::string, running_process> processes;
  std::map<std::string, followed_log> logs;
  alarm timer;
};

/// The PROCESS RUNTIME. Messages: messages/inside/runtime.hpp.
process_runtime_actor::behavior_type process_runtime(
    process_runtime_actor::stateful_pointer<process_runtime_state> self,
    const process_runtime_config& config, container_listener_actor listener);

// INTERNAL to the process runtime: reading and following logs.

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
