#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/problem.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::allocation {

/// For every candidate that fits alone, why it does not help when the steps
/// of `conflict` cannot be placed together: what they and this one need of
/// the node, and what of it is free.
std::vector<rejected_candidate>
explain_conflict(const search_space& space,
                 const std::vector<std::size_t>& conflict);

/// The sentence that says which steps are in the way of an allocation.
std::string conflict_text(const problem& asked, const candidate_set& candidates,
                          const std::vector<std::size_t>& conflict);

/// The best allocation in which one step is not placed as `chosen` places it:
/// the answer to why it is placed there. Its total is not below that of an
/// optimal `chosen`. Infeasible where nothing else is possible.
result alternative(problem asked, const result& chosen, std::size_t step,
                   const limits& bounds = {});

/// One resource of a node, before and after an allocation. CPU is in cores,
/// the others in MiB; `name` is cpu, memory, disk, or gpu_ and an index.
struct use {
  std::size_t node = 0;
  std::string name;
  double capacity = 0;
  double before = 0;
  double after = 0;
};

/// The resources of the nodes that host a step, in the order of the nodes. GPU
/// memory of a unified-memory node counts as its memory.
std::vector<use> uses(const problem& asked,
                      const std::vector<placement>& placements);

} // namespace roscell::allocation
