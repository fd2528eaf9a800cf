#pragma once

#include "actors/instances/process/process_instance.hpp"

#include <string>

/// INTERNAL to the process runtime: the cgroups of its instances.
namespace roscell {

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
