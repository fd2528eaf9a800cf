#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>

/// The discovery servers of members, as the cell's own one sees them.
namespace roscell {

/// The session with a member begins: its discovery server, if it has one, is
/// met anew before `then`, whether that succeeds or not.
void meet_member_server(coordinator_pointer self, int64_t server_id,
                        const node_registration& node,
                        std::function<void()> then);

/// The session of a row's node has ended, or the row goes.
void follow_member_server(coordinator_pointer self, const registry_entry& entry,
                          server_contact contact);

} // namespace roscell
