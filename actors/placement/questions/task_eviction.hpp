#pragma once

#include "actors/placement/search/problem.hpp"
#include "messages/inside/placement.hpp"

#include <optional>
#include <vector>

namespace roscell {

/// What is preempted for a task, and the problem without it.
struct task_eviction {
  allocation::problem problem;
  std::vector<preempted_instance> preempted;
  bool optimal = true; ///< No cheaper one does.
};

/// What must go before a task fits: instances whose priority is lower than that
/// of each of its steps. Nothing if that is not enough, or not found in time.
std::optional<task_eviction> evict_for(const allocate_task& asked,
                                       const allocation::problem& problem,
                                       const allocation::limits& limits);

} // namespace roscell
