#pragma once

#include "actors/cell/cell_coordinator.hpp"

#include <functional>
#include <string>

/// How the CELL COORDINATOR lets a member go: to another cell or to
/// independence. The states are drawn in docs/protocols.md.
namespace roscell {

struct transfer_wish {
  std::string node;
  std::string target; ///< Name of the cell; empty: independence.
  instance_policy instances = instance_policy::refuse;
  join_origin origin = join_origin::chosen;
};

/// Called once, with the failure if there is one.
using transfer_done = std::function<void(const cell_transfer&, const failure*)>;

/// Lets a node of this cell go. `done` hears of the outcome, or that it cannot
/// be known in time.
void start_transfer(coordinator_pointer self, const transfer_wish& wish,
                    transfer_done done);

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
