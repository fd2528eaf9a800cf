#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <chrono>

/// When sessions to other coordinators are to be tried.
namespace roscell {

bool is_coordinator(const node_presence& who);

/// A coordinator is due when it is visible, has no session, and opening it is
/// our part.
bool is_due(const cell_coordinator_state& st, const node_presence& who,
            std::chrono::steady_clock::time_point now);

std::chrono::steady_clock::time_point
next_peer_attempt(const cell_coordinator_state& st);

} // namespace roscell
