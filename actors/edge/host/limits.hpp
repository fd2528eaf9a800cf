#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Reading what a host has and uses.
namespace roscell::limits {

namespace resource {

/// CPU use is a rate over at least the first and at most the second.
constexpr seconds least_sample_age{1};
constexpr seconds most_sample_age{30};
/// Samples closer than this are one; so that many always span more than
/// `least_sample_age`.
constexpr milliseconds sample_distance{100};
constexpr size_t samples = 16;

} // namespace resource

} // namespace roscell::limits
