#include "actors/edge/host/host_probe_capacity.hpp"

#include "actors/edge/host/host_probe_files.hpp"

#include <algorithm>
#include <charconv>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// In cores or MiB: more than any machine has, and exact as a double.
constexpr double max_bound = 1e12;

edge_error wrong_part(std::string_view part, const std::string& why) {
  return {error_code::schema_violation,
          "capacity \"" + std::string{part.substr(0, 80)} + "\": " + why,
          "write KEY=NUMBER,... with the keys cpu (cores), memory_mib, "
          "disk_mib and gpuN_memory_mib (N is the GPU's index)"};
}

std::optional<double> to_bound(std::string_view text) {
  double result = 0;
  auto* last = text.data() + text.size();
  auto [ptr, ec] =
      std::from_chars(text.data(), last, result, std::chars_format::fixed);
  // The comparison is false for "nan", too.
  if (ec != std::errc{} || ptr != last || !(result >= 0 && result <= max_bound))
    return std::nullopt;
  return result;
}

/// The N of "gpuN_memory_mib".
std::optional<int> gpu_index(std::string_view key) {
  constexpr std::string_view head = "gpu";
  constexpr std::string_view tail = "_memory_mib";
  if (key.size() <= head.size() + tail.size()
      || key.substr(0, head.size()) != head
      || key.substr(key.size() - tail.size()) != tail)
    return std::nullopt;
  auto digits = key.substr(head.size(), key.size() - head.size() - tail.size());
  int result = 0;
  auto* last = digits.data() + digits.size();
  auto [ptr, ec] = std::from_chars(digits.data(), last, result);
  if (ec != std::errc{} || ptr != last || result < 0 || digits.size() > 2)
    return std::nullopt;
  return result;
}

/// What is wrong with this part, empty if nothing.
std::string read_part(capacity_bound& bound, std::string_view key,
                      std::string_view text) {
  auto value = to_bound(text);
  if (!value)
    return "the value must be a number from 0 to 1e12";
  if (auto index = gpu_index(key))
    return bound.gpu_memory_mib.emplace(*index, *value).second
               ? ""
               : "the key is given twice";
  std::optional<double>* member = key == "cpu"          ? &bound.cpu
                                  : key == "memory_mib" ? &bound.memory_mib
                                  : key == "disk_mib"   ? &bound.disk_mib
                                                        : nullptr;
  if (member == nullptr)
    return "unknown key \"" + std::string{key.substr(0, 80)} + '"';
  return std::exchange(*member, value) ? "the key is given twice" : "";
}

void limit(amount& x, std::optional<double> bound) {
  if (!bound || *bound >= x.capacity)
    return;
  x.used = std::max(0.0, x.used - (x.capacity - *bound));
  x.capacity = *bound;
}

} // namespace

edge_result<capacity_bound> parse_capacity(std::string_view text) {
  capacity_bound result;
  while (!text.empty()) {
    auto part = text.substr(0, text.find(','));
    auto equals = part.find('=');
    if (equals == std::string_view::npos)
      return wrong_part(part, "there is no \"=\"");
    auto why =
        read_part(result, part.substr(0, equals), part.substr(equals + 1));
    if (!why.empty())
      return wrong_part(part, why);
    text.remove_prefix(part.size());
    if (text == ",")
      return wrong_part(text, "nothing follows the last comma");
    if (!text.empty())
      text.remove_prefix(1);
  }
  return result;
}

host_resources apply_bound(host_resources host, const capacity_bound& bound) {
  limit(host.cpu, bound.cpu);
  limit(host.memory_mib, bound.memory_mib);
  limit(host.disk_mib, bound.disk_mib);
  for (auto& gpu : host.gpus)
    if (auto i = bound.gpu_memory_mib.find(gpu.index);
        i != bound.gpu_memory_mib.end())
      limit(gpu.memory_mib, i->second);
  return host;
}

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
