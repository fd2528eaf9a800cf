#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>

/// The discovery servers of members, as the cell's own one sees them.
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

} // namespace roscell
