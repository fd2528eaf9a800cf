#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/process/notification.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>

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

// How a program that runs is told that variables of its environment have other
// values: by a FIFO beside its NOTIFY_SOCKET. It has a reader as long as the
// program listens, so that one that does not is known.

/// Where it lies for a NOTIFY_SOCKET.
std::filesystem::path
environment_file_of(const std::filesystem::path& notify_socket);

/// Makes one, before the program is started, in place of an older one.
void make_environment_file(const std::filesystem::path& file);

/// Writes the variables, as a JSON object of texts on a line. False where
/// nobody listens, or they cannot be written. Never blocks.
bool write_environment_update(
    const std::filesystem::path& file,
    const std::map<std::string, std::string>& variables);

/// The same for an instance, wherever its runtime has the file.
using environment_writer =
    std::function<bool(const std::string& instance,
                       const std::map<std::string, std::string>& variables)>;

} // namespace roscell
