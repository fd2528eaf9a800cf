#include "actors/placement/questions/step_ways.hpp"

#include "actors/placement/reading/stream_names.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// Whether the search cannot tell two deployment options apart.
bool asks_for_the_same(const deployment_option& x, const deployment_option& y) {
  return x.name == y.name && x.architectures == y.architectures
         && x.resources == y.resources && x.devices == y.devices
         && x.labels == y.labels && x.capabilities == y.capabilities
         && x.scheduling == y.scheduling;
}

allocation::deployment convert(const deployment_option& x) {
  const auto& r = x.resources;
  return {x.name,
          x.architectures,
          r.cpu,
          r.memory_mib,
          r.disk_mib,
          r.needs_gpu(),
          r.needs_gpu() ? r.gpu_memory_mib : 0,
          x.devices,
          x.labels,
          {}};
}

/// An end that is a device asks for it by itself.
std::vector<std::string> devices_of(const task_step& step) {
  std::vector<std::string> result;
  for (const auto* ends : {&step.input, &step.output})
    for (const auto& end : *ends)
      if (is_device(end.endpoint))
        result.push_back(end.endpoint);
  return result;
}

void add_missing(std::vector<std::string>& to,
                 const std::vector<std::string>& devices) {
  for (const auto& device : devices)
    if (std::find(to.begin(), to.end(), device) == to.end())
      to.push_back(device);
}

} // namespace

step_ways::step_ways(const resolved_step& step) : step_(step) {
  for (const auto& build : step.builds)
    for (const auto& option : build.model.deployments)
      add(option, build);
}

void step_ways::add(const deployment_option& option, const skill_build& build) {
  auto known = std::find_if(ways_.begin(), ways_.end(), [&](const way& x) {
    return asks_for_the_same(x.option, option);
  });
  if (known == ways_.end())
    known = ways_.insert(known, way{option, {}});
  for (const auto& node : build.nodes)
    known->builds.emplace(node, build.hash);
}

allocation::step step_ways::to_search() const {
  allocation::step result{
      step_.step.id, {}, step_.step.labels, {}, step_.together};
  const auto devices = devices_of(step_.step);
  for (const auto& build : step_.builds)
    result.nodes_with_skill.insert(build.nodes.begin(), build.nodes.end());
  for (size_t i = 0; i < ways_.size(); ++i) {
    auto way = convert(ways_[i].option);
    // Options of two builds may have one name; the search wants one each.
    way.name += " (" + std::to_string(i) + ")";
    add_missing(way.devices, devices);
    for (const auto& [node, build] : ways_[i].builds)
      way.only_on.insert(node);
    result.deployments.push_back(std::move(way));
  }
  return result;
}

std::string step_ways::build(size_t way, const std::string& node) const {
  const auto& builds = ways_[way].builds;
  const auto found = builds.find(node);
  return found == builds.end() ? std::string{} : found->second;
}

size_t step_ways::find(const std::string& deployment,
                       const std::string& node) const {
  const auto found =
      std::find_if(ways_.begin(), ways_.end(), [&](const way& x) {
        return x.option.name == deployment && x.builds.count(node) > 0;
      });
  return static_cast<size_t>(found - ways_.begin());
}

} // namespace roscell
