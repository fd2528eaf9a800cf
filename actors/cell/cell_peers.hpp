#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does about other coordinators: it opens sessions
/// to those that are announced, and weighs what they tell.
namespace roscell {

/// Another coordinator has opened a session.
void on_peer_admitted(coordinator_pointer self, const session_admitted& event);

void on_peer_opened(coordinator_pointer self, const peer_opened& event);
void on_peer_lost(coordinator_pointer self, const peer_lost& event);

/// A peer has ended without a word.
void on_peer_down(coordinator_pointer self, const caf::actor_addr& gone);

void on_peer_status_reported(coordinator_pointer self,
                             const peer_status_reported& event);
void on_peer_changed(coordinator_pointer self, const peer_changed& event);

/// Tries the sessions that are due.
void open_due_peers(coordinator_pointer self);

} // namespace roscell
