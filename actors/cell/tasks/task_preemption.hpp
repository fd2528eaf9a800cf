#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>
#include <vector>

/// How the CELL COORDINATOR makes way for a task of higher priority: what goes
/// is ended, once it is safe, and started again where there is still room.
namespace roscell {

/// What runs in the cell, of any priority.
std::vector<evictable_instance> evictable_in(const cell_coordinator_state& st);

/// Ends these instances, whose room a task that is being deployed holds
/// already, and replies once they are gone.
caf::result<way_made> clear_way(coordinator_pointer self, const make_way& wish);

/// A task runs, or has come to nothing: what has made way for it is started
/// again, those of the highest priority first. What does not fit stays ended,
/// as failed, until its task is asked for again.
void restore_preempted(coordinator_pointer self, const std::string& task);

} // namespace roscell
