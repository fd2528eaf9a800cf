#pragma once

#include "actors/edge/process/process_spawner.hpp"
#include "actors/instances/process/process_instance.hpp"

#include <filesystem>

/// INTERNAL to the process runtime: how a shim is told what to run.
namespace roscell {

/// Says whose a program is, for the whole host and all nodes on it.
constexpr const char* folder_variable = "ROSCELL_INSTANCE_DIR";

/// The shim of an instance, whose records go to `dir`.
program shim_for(const process_runtime_config& config,
                 const std::filesystem::path& dir,
                 const start_container& request, const instance_cgroup& cgroup);

} // namespace roscell
