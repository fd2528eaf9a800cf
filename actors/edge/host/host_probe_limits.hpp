#pragma once

#include "actors/edge/host/host_probe_capacity.hpp"

#include <string>

/// INTERNAL to this folder.
namespace roscell {

/// What the cgroups of this process, their parents included, leave it: CPU
/// quota and memory limit, of version 2 and of version 1. Files that are not
/// there bound nothing. `root` stands before /proc and /sys.
capacity_bound cgroup_bound(const std::string& root);

} // namespace roscell
