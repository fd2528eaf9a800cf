#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/watch.hpp"

#include <cstddef>
#include <vector>

namespace roscell::allocation {

enum class verdict { fits, impossible, unknown };

struct feasibility {
  verdict what = verdict::unknown;
  /// When `fits`: a choice for each of the steps asked about, 0 for others.
  assignment found;
};

/// Whether the named steps can be placed together, whatever it costs. The
/// order of steps has no meaning here, so the hardest are placed first.
/// Unknown after `most_branches`, or when the watch says stop.
feasibility find_fit(const search_space& space,
                     const std::vector<std::size_t>& steps,
                     std::size_t most_branches, watch& until);

/// Out of steps that cannot be placed together, fewer that cannot: each step
/// is left out in turn, and stays out when the others still prove impossible
/// within a bounded effort.
std::vector<std::size_t> smallest_conflict(const search_space& space,
                                           std::vector<std::size_t> steps,
                                           watch& until);

} // namespace roscell::allocation
