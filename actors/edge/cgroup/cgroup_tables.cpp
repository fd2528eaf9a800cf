#include "actors/edge/cgroup/cgroup_tables.hpp"

#include "actors/edge/disk/small_file.hpp"

#include <algorithm>
#include <array>
#include <charconv>

namespace roscell {

namespace {

/// What of version 1 an instance is put into.
constexpr std::array<std::string_view, 5> useful{"memory", "cpu", "cpuacct",
                                                 "freezer", "pids"};

/// Lines of an outside file that are looked at: no host mounts more.
constexpr size_t most_lines = 8192;

std::vector<std::string_view> split(std::string_view text, char by,
                                    size_t most) {
  std::vector<std::string_view> result;
  while (!text.empty() && result.size() < most) {
    const auto end = std::min(text.find(by), text.size());
    result.push_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  return result;
}

std::set<std::string> useful_in(std::string_view words) {
  std::set<std::string> result;
  for (const auto word : split(words, ',', 64))
    if (std::find(useful.begin(), useful.end(), word) != useful.end())
      result.emplace(word);
  return result;
}

bool is_octal(std::string_view digits) {
  return digits.size() == 3
         && digits.find_first_not_of("01234567") == std::string_view::npos;
}

/// The kernel writes a blank as "\040".
std::string without_escapes(std::string_view text) {
  std::string result;
  for (size_t i = 0; i < text.size(); ++i)
    if (text[i] == '\\' && is_octal(text.substr(i + 1, 3))) {
      result +=
          static_cast<char>((text[i + 1] - '0') * 64 + (text[i + 2] - '0') * 8
                            + text[i + 3] - '0');
      i += 3;
    } else {
      result += text[i];
    }
  return result;
}

/// "31 23 0:28 ROOT POINT OPTIONS [TAGS...] - TYPE SOURCE SUPER-OPTIONS"
std::optional<cgroup_mount> mount_in(std::string_view line) {
  const auto dash = line.find(" - ");
  if (dash == std::string_view::npos)
    return std::nullopt;
  const auto before = split(line.substr(0, dash), ' ', 16);
  const auto after = split(line.substr(dash + 3), ' ', 4);
  if (before.size() < 5 || after.size() < 3)
    return std::nullopt;
  cgroup_mount result;
  result.unified = after[0] == "cgroup2";
  if (after[0] == "cgroup")
    result.controllers = useful_in(after[2]);
  if (!result.unified && result.controllers.empty())
    return std::nullopt;
  result.root = without_escapes(before[3]);
  result.point = without_escapes(before[4]);
  return result;
}

bool is_below(const std::string& path, const std::string& root) {
  return root == "/" || path == root
         || (path.size() > root.size()
             && path.compare(0, root.size(), root) == 0
             && path[root.size()] == '/');
}

bool has_parent_step(const std::string& path) {
  const auto names = split(path, '/', path.size());
  return std::find(names.begin(), names.end(), "..") != names.end();
}

} // namespace

std::vector<cgroup_mount> cgroup_mounts_in(std::string_view mountinfo) {
  std::vector<cgroup_mount> result;
  for (const auto line : split(mountinfo, '\n', most_lines)) {
    auto mount = mount_in(line);
    if (!mount)
      continue;
    const auto same =
        std::find_if(result.begin(), result.end(), [&](const auto& x) {
          return x.unified == mount->unified
                 && x.controllers == mount->controllers;
        });
    if (same == result.end())
      result.push_back(std::move(*mount));
    else if (mount->root.size() < same->root.size())
      *same = std::move(*mount);
  }
  return result;
}

std::vector<cgroup_membership> cgroups_in(std::string_view text) {
  std::vector<cgroup_membership> result;
  for (const auto line : split(text, '\n', most_lines)) {
    const auto first = line.find(':');
    const auto second =
        first == std::string_view::npos ? first : line.find(':', first + 1);
    if (second == std::string_view::npos || line.substr(second + 1, 1) != "/")
      continue;
    const auto words = line.substr(first + 1, second - first - 1);
    cgroup_membership x{useful_in(words), std::string{line.substr(second + 1)}};
    if (words.empty() || !x.controllers.empty())
      result.push_back(std::move(x));
  }
  return result;
}

std::optional<std::filesystem::path> folder_of(const cgroup_mount& mount,
                                               const std::string& path) {
  if (!is_below(path, mount.root) || has_parent_step(path))
    return std::nullopt;
  const auto rest = mount.root == "/" ? path : path.substr(mount.root.size());
  return rest.size() < 2 ? mount.point : mount.point / rest.substr(1);
}

const cgroup_membership* member_of(const cgroup_mount& mount,
                                   const std::vector<cgroup_membership>& all) {
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& x) {
    return x.controllers == mount.controllers;
  });
  return found != all.end() ? &*found : nullptr;
}

std::optional<std::string> up_to_name(const std::string& path,
                                      const std::string& name) {
  const auto at = name.empty() ? std::string::npos : path.find(name);
  if (at == std::string::npos)
    return std::nullopt;
  return path.substr(0, path.find('/', at + name.size()));
}

long long value_of(std::string_view text, std::string_view key) {
  for (const auto line : split(text, '\n', most_lines))
    if (line.size() > key.size() && line.substr(0, key.size()) == key
        && line[key.size()] == ' ')
      return number_alone(line.substr(key.size() + 1));
  return -1;
}

long long number_alone(std::string_view text) {
  const auto last = text.find_last_not_of(" \n");
  text = text.substr(0, last == std::string_view::npos ? 0 : last + 1);
  long long result = -1;
  const auto* end = text.data() + text.size();
  const auto [rest, error] = std::from_chars(text.data(), end, result);
  return error == std::errc{} && rest == end ? result : -1;
}

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
