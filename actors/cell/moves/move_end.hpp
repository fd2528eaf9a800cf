#pragma once

#include "actors/cell/moves/moved_steps.hpp"

#include <functional>
#include <vector>

/// How moves end, as a whole or step by step.
namespace roscell {

/// All of it is done, or needs nothing any more.
void end_move(coordinator_pointer self, const move_ptr& move);

void fail_move(coordinator_pointer self, const move_ptr& move,
               const failure& why);

/// These steps run anew, and that is on disk: where a new one has taken the old
/// one's place the old one goes, else the new one: its task was terminated, or
/// the old one has done its work. Then comes `next`.
///
/// In between anything may end, be terminated or lost: what is to go and cannot
/// be told so is told when it registers.
void complete_steps(coordinator_pointer self, const move_ptr& move,
                    const std::vector<size_t>& steps, move_stage_handler next);

/// The new ones of these steps are not wanted: they go, and their records.
void drop_new(coordinator_pointer self, const move_ptr& move,
              const std::vector<size_t>& steps);

/// The move has a problem: what of it has not moved yet stays where it was. A
/// step whose old instance has ended for it has failed by that; one that is
/// still to end is started anew when it has.
void undo_move(coordinator_pointer self, const move_ptr& move);

/// A move of lost steps: the new ones are in the tables, whatever becomes of
/// them. What has not come up is placed once more.
void complete_lost(coordinator_pointer self, const move_ptr& move);

} // namespace roscell
