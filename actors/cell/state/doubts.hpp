#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <chrono>

/// On whose public word a row of this cell hangs.
namespace roscell {

/// Whether a node with a row that is not active here says that it is in no
/// cell. It may have been released when nobody could tell; or an
/// unauthenticated peer has taken its name. So the row stays until the node has
/// proved it.
bool is_in_doubt(const cell_coordinator_state& st, const node_presence& who);

/// When the next such node is to be asked; max() if none is.
std::chrono::steady_clock::time_point
next_proof(const cell_coordinator_state& st);

} // namespace roscell
