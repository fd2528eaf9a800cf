#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/process/process_spawner.hpp"
#include "actors/instances/process/process_instance.hpp"
#include "messages/inside/runtime.hpp"

#include <filesystem>
#include <optional>
#include <string>

/// INTERNAL to the process runtime: how a shim is told what to run.
namespace roscell {

/// Says whose a program is, for the whole host and all nodes on it.
constexpr const char* folder_variable = "ROSCELL_INSTANCE_DIR";

/// The shim of an instance, whose records go to `dir`.
program shim_for(const process_runtime_config& config,
                 const std::filesystem::path& dir,
                 const start_container& request, const instance_cgroup& cgroup);

// Who a process instance is: the node's user or the one that is granted to its
// skill, with no more of root's power than is granted.

/// Tells the shim who its command is to be, and the command where that user is
/// at home. Errors: engine_failed (there is no such user any more).
std::optional<edge_error> add_identity(const start_container& request,
                                       program& shim);

/// Lets that user reach the instance's NOTIFY_SOCKET and what lies beside it,
/// from the data directory on. Errors: engine_failed.
std::optional<edge_error> let_in(const start_container& request,
                                 const std::filesystem::path& instance_dir);

// INTERNAL to the process runtime: the cgroups of its instances.

instance_bounds bounds_of(const start_container& request);

/// What its folder says of its cgroup, or else its name.
instance_cgroup cgroup_of(const process_runtime_config& config,
                          const std::string& instance);

/// Removes a cgroup in which nobody is left. One that cannot be removed is told
/// of; it is made use of by the next run, or goes at the next start of the
/// node.
void drop_cgroup(const process_runtime_config& config,
                 const std::string& instance, const instance_cgroup& cgroup);

} // namespace roscell
