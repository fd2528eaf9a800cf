#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/edge/process/notification.hpp"
#include "messages/inside/runtime.hpp"
#include "messages/instance.hpp"

#include <caf/error.hpp>
#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <filesystem>
#include <string>

/// What the runtimes of processes and of containers do alike: ids, fences, what
/// a program notifies, and who follows its log. The state is the runtime's own.
namespace roscell {

/// Whether the text can be an instance's id: it names folders and containers,
/// so it has letters, digits, '_', '-' and '.' only and does not begin with a
/// dot.
bool is_instance_id(const std::string& text);

/// Moves the fence in a file on. Where that fails the instance ends in time by
/// itself, so all that is left to do is to tell: by the event `fence_failed`,
/// once until it succeeds again. `fails` keeps how it was.
void keep_fence(const actor_context& context, const std::filesystem::path& file,
                const fence_container& request, bool& fails);

/// What a program has said at its NOTIFY_SOCKET, as its supervisor is told.
inline instance_notified status_notification(const std::string& instance,
                                             const notification& x,
                                             bool heard) {
  return {instance,
          x.ready,
          x.alive,
          x.stopping,
          x.status,
          heard,
          x.safe,
          x.streams,
          x.frames,
          x.remark,
          x.parameters_taken,
          x.parameters_refused,
          x.refusal,
          x.parameters_wanted,
          x.wanted_parameters};
}

// Followers of logs.

/// Someone who waits for more of a log.
struct log_follower {
  log_query query;
  alarm::time_point until;
  caf::typed_response_promise<log_excerpt> promise;
};

/// How long `query` may be kept waiting; zero: not at all.
std::chrono::milliseconds wait_of(const log_query& query);

/// Whether an excerpt is worth an answer before its time is over.
bool says_something(const log_excerpt& x);

/// The error for a log that there is not: unknown_task.
caf::error no_log_of(const std::string& instance);

/// The error for one follower too many: conflict, because an empty answer would
/// be asked again at once.
caf::error too_many_followers();

} // namespace roscell
