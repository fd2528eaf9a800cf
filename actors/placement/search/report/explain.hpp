#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/result.hpp"

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

} // namespace roscell::allocation
