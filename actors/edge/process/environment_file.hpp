#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <string>

/// How a program that runs is told that variables of its environment have other
/// values: by a FIFO beside its NOTIFY_SOCKET. It has a reader as long as the
/// program listens, so that one that does not is known.
namespace roscell {

/// Where it lies for a NOTIFY_SOCKET.
std::filesystem::path
environment_file_of(const std::filesystem::path& notify_socket);

/// Makes one, before the program is started, in place of an older one.
/// Without it the program cannot be told anything; that is no reason not to
/// start it.
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
