#include "actors/edge/cgroup/cgroup_use.hpp"

#include "actors/edge/disk/small_file.hpp"

#include <algorithm>

namespace roscell {

namespace fs = std::filesystem;

namespace {

/// Longer than any file that is read here; `memory.stat` grows with kernels.
constexpr size_t most_file_bytes = 64 * 1024;

constexpr double bytes_per_mib = 1024.0 * 1024.0;

std::string content_of(const fs::path& file) {
  return read_small_file(file, most_file_bytes).value_or("");
}

long long number_in(const fs::path& file) {
  return number_alone(content_of(file));
}

/// The first of two files, one of each version, that has a number.
long long number_in(const fs::path& folder, const char* unified,
                    const char* version_1) {
  const auto found = number_in(folder / unified);
  return found >= 0 ? found : number_in(folder / version_1);
}

/// Of files that were read lately, which the kernel drops before it ends
/// anybody.
long long droppable_bytes(const fs::path& folder) {
  const auto text = content_of(folder / "memory.stat");
  const auto total = value_of(text, "total_inactive_file");
  return std::max(0LL, total >= 0 ? total : value_of(text, "inactive_file"));
}

void read_memory(const fs::path& folder, cgroup_use& to) {
  const auto used =
      number_in(folder, "memory.current", "memory.usage_in_bytes");
  if (used < 0)
    return;
  to.memory_mib =
      static_cast<double>(std::max(0LL, used - droppable_bytes(folder)))
      / bytes_per_mib;
  // Version 1 says "none" by a number near the largest.
  constexpr long long no_limit = 1LL << 60;
  const auto limit = number_in(folder, "memory.max", "memory.limit_in_bytes");
  if (limit >= 0 && limit < no_limit)
    to.memory_limit_mib = static_cast<double>(limit) / bytes_per_mib;
  auto events = content_of(folder / "memory.events");
  if (events.empty())
    events = content_of(folder / "memory.oom_control");
  to.memory_kills = std::max(0LL, value_of(events, "oom_kill"));
}

void read_cpu(const fs::path& folder, cgroup_use& to) {
  if (const auto ns = number_in(folder / "cpuacct.usage"); ns >= 0)
    to.cpu_s = static_cast<double>(ns) / 1e9;
  else if (const auto us =
               value_of(content_of(folder / "cpu.stat"), "usage_usec");
           us >= 0)
    to.cpu_s = static_cast<double>(us) / 1e6;
}

} // namespace

std::optional<cgroup_use> read_use(const std::vector<fs::path>& folders) {
  cgroup_use result;
  for (const auto& x : folders) {
    read_memory(x, result);
    read_cpu(x, result);
  }
  if (result.memory_mib < 0 && result.cpu_s < 0)
    return std::nullopt;
  return result;
}

std::vector<cgroup_membership> cgroups_of(pid_t process, const fs::path& proc) {
  return cgroups_in(content_of(proc / std::to_string(process) / "cgroup"));
}

std::vector<fs::path> named_cgroup_in(const std::vector<cgroup_membership>& all,
                                      const std::string& name,
                                      const std::vector<cgroup_mount>& mounts) {
  std::vector<fs::path> result;
  for (const auto& mount : mounts) {
    const auto* where = member_of(mount, all);
    const auto path =
        where != nullptr ? up_to_name(where->path, name) : std::nullopt;
    if (const auto folder = path ? folder_of(mount, *path) : std::nullopt)
      result.push_back(*folder);
  }
  return result;
}

} // namespace roscell
