#pragma once

#include "actors/placement/search/problem.hpp"
#include "actors/placement/search/result.hpp"

namespace roscell::allocation {

/// Places every step so that equation (1) of the paper is minimal and
/// constraints (3) hold. Exact unless `bounds` ends the search early. Never
/// throws on bad numbers: the outcome is then `invalid` and says which.
/// Pure: equal problems give equal answers, whatever the order of calls.
result allocate(const problem& asked, const limits& bounds = {});

} // namespace roscell::allocation
