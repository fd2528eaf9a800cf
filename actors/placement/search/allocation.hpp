#pragma once

#include "actors/placement/search/problem.hpp"

namespace roscell::allocation {

/// Places every step so that equation (1) of the paper is minimal and
/// constraints (3) hold. Exact unless `bounds` ends the search early. Never
/// throws on bad numbers: the outcome is then `invalid` and says which.
/// Pure: equal problems give equal answers, whatever the order of calls.
result allocate(const problem& asked, const limits& bounds = {});

/// An allocation, and how the CPU was read for it.
struct floored_result {
  problem read; ///< What `found` is the answer to.
  result found;
  bool cpu_floor = false; ///< Compressible use was not counted.
};

/// The problem in which what is compressible counts as free. Exclusions of the
/// strict reading are left out.
problem read_with_floor(problem asked);

/// Reads the CPU strictly, as the paper does. Only where that is proven to have
/// no allocation, it is read with the floor, so the answer is the optimum of
/// the first of the two that has one. A refusal is that of the second, which
/// leaves nothing out that could be free.
floored_result allocate_with_floor(problem asked, const limits& bounds = {});

} // namespace roscell::allocation
