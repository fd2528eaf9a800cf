#pragma once

#include "actors/placement/search/problem.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roscell::allocation {

/// Largest CPU, memory or disk number taken: an exbibyte in MiB. Beyond it,
/// the tolerance of a fit would drown in rounding.
constexpr double max_amount = 1e12;

/// Largest weight of the load term, and largest magnitude of the GPU bonus.
constexpr double max_weight = 1e6;

/// Bounds the depth of the search.
constexpr std::size_t max_steps = 128;

/// Bounds the memory of the search: steps times nodes times deployments,
/// each GPU deployment counted once per GPU.
constexpr std::size_t max_candidates = 250'000;

/// Why the problem cannot be worked on, naming the place such as
/// "nodes[1].cpu.used", or nothing when it can.
std::optional<std::string> validate(const problem& asked);

/// What is odd but workable: use above capacity, which counts as full.
std::vector<std::string> warnings_about(const problem& asked);

} // namespace roscell::allocation
