#pragma once

#include "actors/placement/search/allocation.hpp"
#include "brute_force.hpp"

#include <cstdint>
#include <vector>

namespace roscell::allocation::test {

/// A small random instance: ties, exact fits, full nodes, unified memory,
/// several GPUs, missing skills and more, the same for the same seed.
oracle::instance random_instance(std::uint32_t seed);

/// The same instance in the library's terms.
problem translated(const oracle::instance& in);

/// An answer in the oracle's terms.
std::vector<oracle::pick> picks(const result& answer);

/// How many random cases to run: ROSCELL_ALLOCATION_CASES, or the given.
int case_count(int otherwise);

} // namespace roscell::allocation::test
