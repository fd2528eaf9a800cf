#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/watch.hpp"

#include <optional>

namespace roscell::allocation {

/// Places each step in turn where the score so far is least. Nothing when a
/// step finds no room, which does not mean that there is none.
std::optional<assignment> greedy(const search_space& space);

/// Moves one step at a time to where the score falls most, until no move
/// helps. `guess` must fit.
assignment improved(const search_space& space, assignment guess, watch& until);

} // namespace roscell::allocation
