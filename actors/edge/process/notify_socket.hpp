#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/notification.hpp"

#include <filesystem>

namespace roscell {

/// Where the NOTIFY_SOCKET of an instance lies: in its folder, or, where that
/// path is too long for a Unix socket, below /run or /tmp under a name derived
/// from it. The same folder always gets the same path, so that a program finds
/// the socket of a node that was restarted.
std::filesystem::path notify_path(const std::filesystem::path& instance_dir);

/// Makes the datagram socket at `path`, in place of an older one. Its folder
/// is made if need be and must belong to nobody else.
/// Errors: engine_failed.
edge_result<unique_fd> open_notify_socket(const std::filesystem::path& path);

/// Reads what has arrived at the socket, without waiting; at most as many
/// datagrams as its queue can hold at a time.
notification receive_notifications(int socket);

} // namespace roscell
