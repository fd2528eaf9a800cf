#pragma once

#include "actors/edge/host/host_probe.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// At most how much of its host a node offers, so that several nodes, or a node
/// and other programs, can share it. What is not named is not bounded.
struct capacity_bound {
  std::optional<double> cpu; ///< In cores.
  std::optional<double> memory_mib;
  std::optional<double> disk_mib;
  std::map<int, double> gpu_memory_mib; ///< By GPU index.
};

/// Reads "cpu=2,memory_mib=2048,disk_mib=1000,gpu0_memory_mib=4000". Refused
/// with `schema_violation`: the message names the part that is wrong, the hint
/// lists the keys. An empty text bounds nothing.
edge_result<capacity_bound> parse_capacity(std::string_view text);

/// The slice of `host` that `bound` leaves. For each resource:
///
///     capacity = min(host capacity, bound)
///     used     = max(0, host used - (host capacity - capacity))
///
/// so use by others is taken to lie outside the slice as far as there is room
/// for it outside. A bound above the host's capacity changes nothing.
host_resources apply_bound(host_resources host, const capacity_bound& bound);

// INTERNAL to this folder.

/// What the cgroups of this process, their parents included, leave it: CPU
/// quota and memory limit, of version 2 and of version 1. Files that are not
/// there bound nothing. `root` stands before /proc and /sys.
capacity_bound cgroup_bound(const std::string& root);

} // namespace roscell
