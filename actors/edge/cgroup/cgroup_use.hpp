#pragma once

#include "actors/edge/cgroup/cgroup_tables.hpp"

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// What those in one cgroup take. Negative: not known.
struct cgroup_use {
  double memory_mib = -1;       ///< Without files that the kernel can drop.
  double memory_limit_mib = -1; ///< Negative: none.
  double cpu_s = -1;            ///< Since the cgroup was made.
  long long memory_kills = 0;   ///< Processes that were ended for memory.
};

/// Reads it from the folders of one cgroup, one in each hierarchy; nothing
/// where these say nothing.
std::optional<cgroup_use>
read_use(const std::vector<std::filesystem::path>& folders);

/// Where a process is; none where that cannot be read.
/// @param proc where proc(5) is.
std::vector<cgroup_membership>
cgroups_of(pid_t process, const std::filesystem::path& proc = "/proc");

/// The folders of the cgroup that is named after something, among those that a
/// process with these memberships is in or below.
std::vector<std::filesystem::path>
named_cgroup_in(const std::vector<cgroup_membership>& all,
                const std::string& name,
                const std::vector<cgroup_mount>& mounts);

} // namespace roscell
