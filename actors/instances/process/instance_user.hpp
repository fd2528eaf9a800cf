#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "messages/inside/runtime.hpp"

#include <filesystem>
#include <optional>

/// Who a process instance is: the node's user or the one that is granted to its
/// skill, with no more of root's power than is granted.
namespace roscell {

/// Tells the shim who its command is to be, and the command where that user is
/// at home. Errors: engine_failed (there is no such user any more).
std::optional<edge_error> add_identity(const start_container& request,
                                       program& shim);

/// Lets that user reach the instance's NOTIFY_SOCKET and what lies beside it,
/// from the data directory on. Errors: engine_failed.
std::optional<edge_error> let_in(const start_container& request,
                                 const std::filesystem::path& instance_dir);

} // namespace roscell
