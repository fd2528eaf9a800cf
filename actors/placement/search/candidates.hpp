#pragma once

#include "actors/placement/search/occupancy.hpp"
#include "actors/placement/search/problem.hpp"
#include "actors/placement/search/result.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roscell::allocation {

/// The candidates that each step could use if it were the only one, in the
/// order of nodes, deployments and GPU indices: the sets C_i of the paper.
struct candidate_set {
  /// Per step.
  std::vector<std::vector<candidate>> of;
  /// The candidates of step i on node v are `of[i][from[i][v]]` up to, not
  /// including, `of[i][from[i][v + 1]]`.
  std::vector<std::vector<std::uint32_t>> from;
  /// For each node, the nearest earlier node that every step sees alike, or
  /// -1: the same amounts, GPUs and candidates. Names and labels may differ.
  std::vector<std::ptrdiff_t> twins;
};

/// Every candidate lands in the returned set or, with its reasons, in
/// `rejected`.
candidate_set find_candidates(const problem& asked,
                              std::vector<rejected_candidate>& rejected);

} // namespace roscell::allocation
