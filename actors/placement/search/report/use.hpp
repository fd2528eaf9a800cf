#pragma once

#include "actors/placement/search/problem.hpp"
#include "actors/placement/search/result.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::allocation {

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
