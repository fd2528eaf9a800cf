#pragma once

#include "actors/edge/history/history_folder.hpp"
#include "messages/messages.hpp"

#include <caf/result.hpp>

/// INTERNAL to the node history: logs of instances that are gone.
namespace roscell {

/// A part of the newest log of that instance. Errors: unknown_task (none is
/// kept).
caf::result<log_excerpt> read_kept_log(const history_folder& history,
                                       const log_query& query);

kept_logs list_kept_logs(const history_folder& history,
                         const kept_logs_query& query);

} // namespace roscell
