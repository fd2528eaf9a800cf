#pragma once

#include "actors/placement/search/problem.hpp"

#include <cstddef>
#include <vector>

namespace roscell::allocation {

/// Priorities are 0 to 9.
constexpr int priorities = 10;

/// Something that runs on a node, and the room that it would give back. Its
/// room is part of what is in use there.
struct holder {
  std::size_t node = 0; ///< Position in the problem.
  int priority = 0;
  double cpu = 0;
  double memory_mib = 0;
  double disk_mib = 0;
  double gpu_memory_mib = 0;
  int gpu = -1; ///< The index that the node gives it; negative: none.
};

/// What must go. `what` is as of a search: `optimal` where nothing cheaper
/// does, `best_found` where the search was stopped before it was proven.
struct eviction {
  outcome what = outcome::infeasible;
  std::vector<std::size_t> holders; ///< Positions, ascending.
};

/// The holders that must go before every step fits: the fewest; among equally
/// many, those whose highest priority is the lowest, then the next one, and so
/// on. Exact unless `bounds` ends the search early.
eviction find_eviction(const problem& asked, const std::vector<holder>& holders,
                       const limits& bounds = {});

/// The problem once these holders are gone.
problem without(problem asked, const std::vector<holder>& holders,
                const std::vector<std::size_t>& gone);

} // namespace roscell::allocation
