#include "actors/placement/questions/task_eviction.hpp"

#include "actors/placement/questions/search_problem.hpp"
#include "actors/placement/search/cpu_floor.hpp"
#include "actors/placement/search/running/eviction.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

int64_t least_priority(const allocate_task& asked) {
  int64_t result = allocation::priorities;
  for (const auto& x : asked.steps)
    result = std::min(result, x.step.priority);
  return result;
}

allocation::holder holder_of(const evictable_instance& x, size_t node) {
  return {node,
          static_cast<int>(x.who.priority),
          x.resources.cpu,
          x.resources.memory_mib,
          x.resources.disk_mib,
          std::max(0.0, x.resources.gpu_memory_mib),
          x.gpu};
}

} // namespace

std::optional<task_eviction> evict_for(const allocate_task& asked,
                                       const allocation::problem& problem,
                                       const allocation::limits& limits) {
  const auto floor = least_priority(asked);
  std::vector<allocation::holder> holders;
  std::vector<preempted_instance> who;
  for (const auto& x : asked.evictable) {
    const auto node = node_position(asked.nodes, x.who.node);
    if (node == asked.nodes.size() || x.who.priority >= floor
        || x.who.priority < 0)
      continue;
    holders.push_back(holder_of(x, node));
    who.push_back(x.who);
  }
  // The reading of the CPU with which the least has to go.
  const auto found = allocation::find_eviction(
      allocation::read_with_floor(problem), holders, limits);
  if (found.holders.empty())
    return std::nullopt;
  task_eviction result;
  result.problem = allocation::without(problem, holders, found.holders);
  result.optimal = found.what == allocation::outcome::optimal;
  for (const auto i : found.holders)
    result.preempted.push_back(who[i]);
  return result;
}

} // namespace roscell
