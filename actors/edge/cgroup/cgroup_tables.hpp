#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// What the kernel says of control groups, as text from outside. Pure.
namespace roscell {

/// One hierarchy that is mounted.
struct cgroup_mount {
  bool unified = false;              ///< Version 2.
  std::set<std::string> controllers; ///< Of version 1.
  std::string root;                  ///< What of the hierarchy is mounted,
  std::filesystem::path point;       ///< and where.
};

/// Where a process is in one hierarchy.
struct cgroup_membership {
  std::set<std::string> controllers; ///< Of version 1; none: version 2.
  std::string path;                  ///< Begins with '/'.
};

/// The hierarchies in a /proc/PID/mountinfo, without those of version 1 that
/// hold nothing of what limits an instance. Where one is mounted several times
/// the mount of the largest part counts. What cannot be read is passed over.
std::vector<cgroup_mount> cgroup_mounts_in(std::string_view mountinfo);

/// What a /proc/PID/cgroup says.
std::vector<cgroup_membership> cgroups_in(std::string_view text);

/// The folder of a cgroup; none where it lies outside of what is mounted.
std::optional<std::filesystem::path> folder_of(const cgroup_mount& mount,
                                               const std::string& path);

/// Where a process with these memberships is in that hierarchy.
const cgroup_membership* member_of(const cgroup_mount& mount,
                                   const std::vector<cgroup_membership>& all);

/// The beginning of a path, to the end of the first name that contains `name`;
/// none where there is no such.
std::optional<std::string> up_to_name(const std::string& path,
                                      const std::string& name);

/// The number after `key` and a blank, at the beginning of a line: "oom_kill
/// 3". Negative: there is none.
long long value_of(std::string_view text, std::string_view key);

/// A whole number alone, or "max"; negative: neither, or no bound.
long long number_alone(std::string_view text);

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
