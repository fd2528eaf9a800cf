#pragma once

#include "actors/placement/search/occupancy.hpp"
#include "actors/placement/search/problem.hpp"
#include "actors/placement/search/result.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::allocation {

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
