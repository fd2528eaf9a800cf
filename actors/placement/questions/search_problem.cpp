#include "actors/placement/questions/search_problem.hpp"

#include "actors/edge/process/skill_grants.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <variant>

namespace roscell {

namespace {

allocation::amount convert(const amount& x) {
  return {x.capacity, x.used};
}

/// To say "on that robot" needs no label of its own: each node has one with its
/// name, unless its operator has given it another value.
std::map<std::string, std::string> labels_of(const node_resources& x) {
  auto result = x.labels;
  result.emplace("node", x.name);
  return result;
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
                          x.cpu_compressible};
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

} // namespace roscell
