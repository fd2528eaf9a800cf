#include "actors/edge/host/host_probe_capacity.hpp"

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

} // namespace roscell
