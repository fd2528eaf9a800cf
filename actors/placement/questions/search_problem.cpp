#include "actors/placement/questions/search_problem.hpp"

#include <algorithm>

namespace roscell {

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
                          x.labels,
                          x.devices,
                          x.cpu_compressible};
  for (const auto& gpu : x.gpus)
    result.gpus.push_back({gpu.index, convert(gpu.memory_mib)});
  return result;
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
  return result;
}

} // namespace roscell
