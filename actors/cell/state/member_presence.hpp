#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <chrono>
#include <functional>

/// Whether members are there, beyond their lease: their discovery servers as
/// the cell's own one sees them, and nodes that say in public that they are in
/// no cell while they have a row here. Neither has a table of its own.
namespace roscell {

/// The session with a member begins: its discovery server, if it has one, is
/// met anew.
/// @param tells_anew see `node_registration`.
/// @param then called once: when that has succeeded or not, or at once.
void meet_member_server(coordinator_pointer self, int64_t server_id,
                        bool tells_anew, std::function<void()> then);

/// The session of a row's node has ended, or the row goes.
void follow_member_server(coordinator_pointer self, const registry_entry& entry,
                          server_contact contact);

/// Nothing has been heard of its host. If that goes on for a minute its
/// programs are taken for ended, so that nobody sends to them any more. Of a
/// host that has said that the node is not there any more they are not: they go
/// on.
void doubt_silent_host(coordinator_pointer self, const registry_entry& entry);

// Rows that an announcement puts in doubt.

/// Whether a node with a row that is not active here says that it is in no
/// cell. It may have been released when nobody could tell; or an
/// unauthenticated peer has taken its name. So the row stays until the node has
/// proved it.
bool is_in_doubt(const cell_coordinator_state& st, const node_presence& who);

/// When the next such node is to be asked; max() if none is.
std::chrono::steady_clock::time_point
next_proof(const cell_coordinator_state& st);

/// Asks over its session whether the node of a member is there, for a second.
/// A node whose address has changed cannot answer where it was, nor close what
/// it had there; a lease would take it for alive eight seconds longer.
void prove_member(coordinator_pointer self, const member_actor& member,
                  const std::function<void(bool is_there)>& then);

} // namespace roscell
