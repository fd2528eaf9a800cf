#include "actors/edge/host/host_probe_limits.hpp"

#include "actors/edge/host/host_probe_files.hpp"

#include <algorithm>

namespace roscell {

namespace {

void tighten(std::optional<double>& bound, std::optional<double> by) {
  if (by && (!bound || *by < *bound))
    bound = by;
}

std::optional<double> ratio(std::optional<long long> quota,
                            std::optional<long long> period) {
  if (!quota || !period || *quota <= 0 || *period <= 0)
    return std::nullopt;
  return static_cast<double>(*quota) / static_cast<double>(*period);
}

std::optional<long long> number_in(const std::string& path) {
  auto text = read_file(path, 64);
  if (!text)
    return std::nullopt;
  std::string_view rest{*text};
  return to_number(take_word(rest));
}

std::optional<double> mib_in(const std::string& path) {
  // An unlimited version 1 cgroup says 2^63 rounded to pages.
  constexpr long long unlimited = 1LL << 60;
  auto bytes = number_in(path);
  if (!bytes || *bytes <= 0 || *bytes >= unlimited)
    return std::nullopt;
  return static_cast<double>(*bytes) / (1024.0 * 1024.0);
}

/// cpu.max says "QUOTA PERIOD" in microseconds, or "max PERIOD".
std::optional<double> cores_in_cpu_max(const std::string& path) {
  auto text = read_file(path, 64);
  if (!text)
    return std::nullopt;
  std::string_view rest{*text};
  auto quota = to_number(take_word(rest));
  return ratio(quota, to_number(take_word(rest)));
}

/// Calls `visit` with `path` and each of its parents, down to "".
template <class Visitor>
void for_each_ancestor(std::string path, Visitor visit) {
  while (!path.empty()) {
    visit(path);
    path.resize(std::min(path.rfind('/'), path.size() - 1));
  }
  visit(path);
}

void read_version_2(const std::string& base, capacity_bound& bound) {
  tighten(bound.cpu, cores_in_cpu_max(base + "/cpu.max"));
  tighten(bound.memory_mib, mib_in(base + "/memory.max"));
}

void read_version_1_cpu(const std::string& base, capacity_bound& bound) {
  tighten(bound.cpu, ratio(number_in(base + "/cpu.cfs_quota_us"),
                           number_in(base + "/cpu.cfs_period_us")));
}

void read_version_1_memory(const std::string& base, capacity_bound& bound) {
  tighten(bound.memory_mib, mib_in(base + "/memory.limit_in_bytes"));
}

bool contains_word(std::string_view list, std::string_view word) {
  for (;;) {
    auto comma = list.find(',');
    if (list.substr(0, comma) == word)
      return true;
    if (comma == std::string_view::npos)
      return false;
    list.remove_prefix(comma + 1);
  }
}

/// One line of /proc/self/cgroup: "HIERARCHY:CONTROLLERS:PATH".
void read_line(const std::string& mount, std::string_view line,
               capacity_bound& bound) {
  auto first = line.find(':');
  auto second = line.find(':', first + 1);
  if (first == std::string_view::npos || second == std::string_view::npos)
    return;
  auto controllers = line.substr(first + 1, second - first - 1);
  std::string path{line.substr(second + 1)};
  if (path == "/")
    path.clear();
  // Version 1 mounts controllers together under a name such as "cpu,cpuacct".
  auto together = mount + '/' + std::string{controllers};
  for_each_ancestor(path, [&](const std::string& at) {
    if (controllers.empty()) {
      read_version_2(mount + at, bound);
      read_version_2(mount + "/unified" + at, bound);
    }
    if (contains_word(controllers, "cpu"))
      read_version_1_cpu(together + at, bound);
    if (contains_word(controllers, "memory"))
      read_version_1_memory(together + at, bound);
  });
}

} // namespace

capacity_bound cgroup_bound(const std::string& root) {
  capacity_bound result;
  auto text = read_file(root + "/proc/self/cgroup");
  if (!text)
    return result;
  std::string_view rest{*text};
  while (!rest.empty())
    read_line(root + "/sys/fs/cgroup", take_line(rest), result);
  return result;
}

} // namespace roscell
