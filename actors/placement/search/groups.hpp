#pragma once

#include "actors/placement/search/assignment.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace roscell::allocation {

/// The most steps whose subsets are worth a table.
constexpr std::size_t most_grouped_steps = 14;

/// Steps as bits: bit i is step i.
using step_set = std::uint32_t;

inline std::size_t first_of(step_set steps) {
  return static_cast<std::size_t>(__builtin_ctz(steps));
}

/// Steps that share one node, and how. What they cost depends on nothing else.
struct group {
  step_set steps = 0;
  /// Position in `group_list::kinds`.
  std::uint32_t kind = 0;
  /// Position in `group_list::ways` of the first step's candidate.
  std::uint32_t ways = 0;
  /// Sum of variance and bonus of the steps.
  double cost = 0;
  /// Load of the node with these steps on it.
  double load = 0;
};

struct group_list {
  std::vector<group> of;
  /// Per group and step, in their order: the position of the step's candidate
  /// among those it has on the node.
  std::vector<std::uint32_t> ways;
  /// The nodes of each kind, in their order. Nodes of a kind are alike to
  /// every step (see `candidate_set::twins`).
  std::vector<std::vector<std::uint32_t>> kinds;
};

/// Every group that an allocation with a total up to `most_total` can have.
/// `least_cost` bounds per step what it costs in any allocation. Nothing where
/// there are more than `most_groups`, or the watch says stop.
std::optional<group_list> find_groups(const search_space& space,
                                      const std::vector<double>& least_cost,
                                      double most_total,
                                      std::size_t most_groups, watch& until);

} // namespace roscell::allocation
