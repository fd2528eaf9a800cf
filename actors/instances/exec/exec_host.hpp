#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/exec/exec_channel.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/instances/exec/exec_table.hpp"
#include "messages/messages.hpp"

#include <caf/typed_response_promise.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>

namespace roscell {

/// Begins a command. It may block for some milliseconds. Errors: engine_failed,
/// unknown_task (the instance runs no more).
using exec_opener = std::function<edge_result<std::shared_ptr<exec_channel>>(
    const exec_order&, exec_callbacks)>;

struct exec_host_config {
  actor_context context;
  std::string node; ///< The node's name.
  container_supervisor_actor supervisor;
  exec_opener open;
};

/// What of a command the actor alone knows.
struct exec_attachment {
  using time_point = exec_session::time_point;

  /// Somebody who waits, and until when.
  template <class Reply>
  struct waiter {
    caf::typed_response_promise<Reply> promise;
    time_point until;
  };

  struct input_waiter : waiter<exec_input_taken> {
    int64_t offset = 0;
    std::string bytes;
    bool ended = false;
  };

  std::shared_ptr<exec_channel> channel;
  std::optional<caf::typed_response_promise<exec_started>> starter;
  std::optional<waiter<exec_output>> reader;
  std::optional<input_waiter> writer;
};

/// Owns the commands that operators run beside the instances of this node, and
/// ends those whose operators are gone. Spawned as one that blocks: it starts
/// processes. Without commands it has no timer.
struct exec_host_state {
  static constexpr const char* name = "exec-host";

  exec_host_config config;
  exec_table table;
  std::map<std::string, exec_attachment> attached; ///< By session.
  alarm timer;
};

/// The EXEC HOST. Messages: messages/exec.hpp.
exec_host_actor::behavior_type
exec_host(exec_host_actor::stateful_pointer<exec_host_state> self,
          const exec_host_config& config);

} // namespace roscell
