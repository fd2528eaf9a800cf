#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/history/history_folder.hpp"
#include "messages/messages.hpp"

#include <caf/result.hpp>

#include <chrono>
#include <memory>

namespace roscell {

/// Owns what the node keeps of the past. It blocks on the disk.
struct node_history_state {
  static constexpr const char* name = "node-history";

  std::shared_ptr<history_folder> folder;
  uint64_t written = 0; ///< Events.
  uint64_t refused = 0; ///< Those that could not be written.
  /// When the bound was held for the sake of logs, and whether it will be
  /// again.
  std::chrono::steady_clock::time_point held_at{};
  bool holds_soon = false;
};

/// The NODE HISTORY. Messages: messages/inside/storage.hpp.
node_history_actor::behavior_type
node_history(node_history_actor::stateful_pointer<node_history_state> self,
             std::shared_ptr<history_folder> folder);

// INTERNAL to the node history: logs of instances that are gone.

/// A part of the newest log of that instance. Errors: unknown_task (none is
/// kept).
caf::result<log_excerpt> read_kept_log(const history_folder& history,
                                       const log_query& query);

kept_logs list_kept_logs(const history_folder& history,
                         const kept_logs_query& query);

} // namespace roscell
