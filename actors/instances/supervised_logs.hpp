#pragma once

#include "actors/instances/instance_removal.hpp"

#include <caf/result.hpp>

/// INTERNAL to the container supervisor: logs of its instances, and of those
/// that are gone.
namespace roscell {

/// A part of the log of an instance, or of the one that was kept of it. Errors:
/// unknown_task.
caf::result<log_excerpt> read_log(container_supervisor_pointer self,
                                  const log_query& query);

/// Which logs are kept on this node.
caf::result<kept_logs> list_logs(container_supervisor_pointer self,
                                 const kept_logs_query& query);

/// With what the log of an ended instance is kept.
kept_log about_log_of(const supervised_instance& x);

} // namespace roscell
