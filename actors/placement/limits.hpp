#pragma once

#include "actors/edge/limit_units.hpp"

/// Searching places for steps.
namespace roscell::limits {

namespace task {

/// Searching an allocation while other searches wait.
constexpr seconds search{60};
/// What the search itself may take, for a live cell and for a plan on paper.
constexpr milliseconds allocation_budget{200};
constexpr milliseconds offline_allocation_budget{20'000};
/// What a search for better places of running steps may take.
constexpr milliseconds move_budget{2'000};
/// For one node to keep room.
constexpr seconds reservation{10};

} // namespace task

} // namespace roscell::limits
