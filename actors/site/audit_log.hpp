#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/history/audit_file.hpp"
#include "messages/messages.hpp"

#include <filesystem>
#include <optional>

namespace roscell {

/// Owns the records of who has changed what. Spawned as one that blocks.
struct audit_log_state {
  static constexpr const char* name = "audit-log";

  actor_context context;
  std::optional<audit_file> file;
  bool broken = false; ///< The last record could not be written.
};

/// The AUDIT LOG. Messages: messages/site.hpp. What cannot be written is an
/// `edge_problem`, once until it can be.
audit_log_actor::behavior_type
audit_log(audit_log_actor::stateful_pointer<audit_log_state> self,
          const actor_context& context, const std::filesystem::path& folder);

} // namespace roscell
