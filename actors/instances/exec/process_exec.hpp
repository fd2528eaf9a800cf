#pragma once

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "actors/instances/exec/exec_host.hpp"

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace roscell {

/// The arguments of a shim that runs a command beside the one of another shim:
/// in its folder and its cgroups, scheduled as it is, and as who it is.
/// @param words the arguments of the other shim.
std::vector<std::string> beside(const std::vector<std::string>& words,
                                const exec_order& order);

/// Begins commands beside instances that are processes. Blocks on the host's
/// table of processes.
/// @param shim tools/instance_shim.
exec_opener process_opener(std::shared_ptr<io_core> core,
                           std::filesystem::path shim);

} // namespace roscell
