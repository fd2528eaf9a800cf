#pragma once

#include "actors/cell/moves/moved_steps.hpp"

/// Where what moves goes.
namespace roscell {

/// Finds places for the steps, and has the members keep room. Then comes
/// `next`, while the placement lock is held; or the move has failed.
///
/// In between tasks are terminated, steps end, and nodes leave: what needs no
/// place any more is left out when the places are known.
void place_move(coordinator_pointer self, const move_ptr& move,
                move_stage_handler next);

} // namespace roscell
