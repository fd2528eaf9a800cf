#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does when it is asked to let a node go, to another
/// cell or to independence. The states are drawn in docs/protocols.md.
namespace roscell {

caf::result<node_transferred> transfer_node(coordinator_pointer self,
                                            const node_transfer& request);
caf::result<node_released> release_node(coordinator_pointer self,
                                        const node_release& request);
caf::result<transfer_description>
describe_transfers(coordinator_pointer self, const transfer_query& query);

/// Takes up what an earlier run of the coordinator has left open: what becomes
/// of such a node is told by where it turns up.
void restore_transfers(coordinator_pointer self);

/// Gives up waiting for what is overdue.
void settle_overdue_transfers(coordinator_pointer self);

} // namespace roscell
