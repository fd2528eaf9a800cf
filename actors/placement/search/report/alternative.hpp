#pragma once

#include "actors/placement/search/problem.hpp"
#include "actors/placement/search/result.hpp"

#include <cstddef>

namespace roscell::allocation {

/// The best allocation in which one step is not placed as `chosen` places it:
/// the answer to why it is placed there. Its total is not below that of an
/// optimal `chosen`. Infeasible where nothing else is possible.
result alternative(problem asked, const result& chosen, std::size_t step,
                   const limits& bounds = {});

} // namespace roscell::allocation
