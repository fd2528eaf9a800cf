#pragma once

#include "actors/placement/search/occupancy.hpp"
#include "actors/placement/search/problem.hpp"

#include <cstddef>
#include <cstdint>
#include <string>
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

/// Everything that keeps a step from a candidate with what is free in `now`:
/// skill, architecture, labels, devices, GPU, and each resource that is
/// short. Empty means that it fits.
std::vector<reason> reasons_against(const problem& asked, const occupancy& now,
                                    std::size_t step, const candidate& choice);

/// "needs 2.0 cores, 1.5 free: short by 0.5", in the units of the resource.
std::string shortage_text(resource kind, double needed, double free);

/// The kind of reason for a resource that is short.
reason_kind kind_of(resource kind);

/// Names the candidate's GPU by its index rather than its position.
rejected_candidate rejection(const problem& asked, std::size_t step,
                             const candidate& choice,
                             std::vector<reason> reasons);

} // namespace roscell::allocation
