#include "actors/placement/questions/search_problem.hpp"

#include "actors/edge/process/skill_grants.hpp"
#include "actors/placement/reading/stream_names.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <variant>

namespace roscell {

std::map<std::string, std::string> labels_of(const node_resources& x) {
  auto result = x.labels;
  result.emplace("node", x.name);
  return result;
}

namespace {

allocation::amount convert(const amount& x) {
  return {x.capacity, x.used};
}

allocation::node convert(const node_resources& x) {
  allocation::node result{x.name,
                          x.architecture,
                          x.unified_memory,
                          convert(x.cpu),
                          convert(x.memory_mib),
                          convert(x.disk_mib),
                          {},
                          labels_of(x),
                          x.devices,
                          x.cpu_compressible,
                          x.secrets};
  for (const auto& gpu : x.gpus)
    result.gpus.push_back({gpu.index, convert(gpu.memory_mib)});
  return result;
}

/// What another version of this program grants may not be understood here.
skill_grants grants_of(const node_resources& node) {
  auto read = skill_grants::parse(node.grants);
  auto* known = std::get_if<skill_grants>(&read);
  return known != nullptr ? std::move(*known) : skill_grants{};
}

/// Keeps a way to run a step from a node, on whichever of its GPUs, however the
/// CPU is read.
void exclude_way(allocation::problem& from, size_t step, size_t way,
                 size_t node, const std::string& reason) {
  from.excluded.push_back({step, node, way, -1, reason, true});
  for (const auto& gpu : from.nodes[node].gpus)
    from.excluded.push_back({step, node, way, gpu.index, reason, true});
}

void exclude_ungranted(allocation::problem& from, size_t node,
                       const node_resources& host,
                       const std::vector<step_ways>& ways) {
  const auto granted = grants_of(host);
  for (size_t step = 0; step < ways.size(); ++step)
    for (size_t way = 0; way < ways[step].count(); ++way)
      for (const auto& what :
           granted.missing(ways[step].skill(), ways[step].option(way)))
        exclude_way(from, step, way, node,
                    refusal_text(ways[step].skill(), host.name, what));
}

/// Position of what a name is of; the size of the list if of none.
template <class List, class Name>
size_t position(const List& list, const std::string& wanted, Name name) {
  return static_cast<size_t>(
      std::find_if(list.begin(), list.end(),
                   [&](const auto& x) { return name(x) == wanted; })
      - list.begin());
}

} // namespace

size_t step_position(const std::vector<resolved_step>& steps,
                     const std::string& id) {
  return position(steps, id, [](const auto& x) { return x.step.id; });
}

size_t node_position(const std::vector<node_resources>& nodes,
                     const std::string& name) {
  return position(nodes, name, [](const auto& x) { return x.name; });
}

int64_t bytes_to_fetch(const resolved_step& step, const std::string& build,
                       const std::string& node) {
  for (const auto& x : step.builds)
    if (x.hash == build)
      return std::count(x.lacking.begin(), x.lacking.end(), node) * x.bytes;
  return 0;
}

std::vector<node_resources>
in_order_of_fetching(std::vector<node_resources> nodes,
                     const std::vector<resolved_step>& steps) {
  std::map<std::string, int64_t> bytes;
  for (const auto& step : steps)
    for (const auto& build : step.builds)
      for (const auto& node : build.lacking)
        if (std::find(build.nodes.begin(), build.nodes.end(), node)
            != build.nodes.end())
          bytes[node] += build.bytes;
  const auto of = [&](const node_resources& x) {
    const auto found = bytes.find(x.name);
    return found == bytes.end() ? 0 : found->second;
  };
  std::stable_sort(nodes.begin(), nodes.end(),
                   [&](const auto& a, const auto& b) { return of(a) < of(b); });
  return nodes;
}

std::vector<step_ways> ways_of(const std::vector<resolved_step>& steps) {
  return {steps.begin(), steps.end()};
}

allocation::problem make_problem(const std::vector<node_resources>& nodes,
                                 const std::vector<step_ways>& ways) {
  allocation::problem result;
  for (const auto& node : nodes)
    result.nodes.push_back(convert(node));
  for (const auto& x : ways)
    result.steps.push_back(x.to_search());
  for (size_t i = 0; i < nodes.size(); ++i)
    exclude_ungranted(result, i, nodes[i], ways);
  return result;
}

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
  result.secrets.insert(step_.step.secrets.begin(), step_.step.secrets.end());
  for (const auto& [variable, secret] : step_.step.secret_env)
    result.secrets.insert(secret);
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
