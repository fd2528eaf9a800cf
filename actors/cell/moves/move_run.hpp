#pragma once

#include "actors/cell/moves/moved_steps.hpp"

/// INTERNAL to moves and restarts: one move from the search for places to its
/// end, as the move table says.
namespace roscell {

/// The move has the placement lock, and its steps. `done` is called once, with
/// the first problem or null; each stage ends, at the latest with its deadline.
void run_move(coordinator_pointer self, const move_ptr& move);

} // namespace roscell
