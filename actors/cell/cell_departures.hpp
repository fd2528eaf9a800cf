#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// How nodes leave: the CELL COORDINATOR drains them, which moves what they run
/// to others as these have room, and transfers them to another cell or releases
/// them to none. Drains stand in `st.drains`, transfers in `st.transfers`; both
/// are on the disk before a node hears of them, and are taken up after a
/// restart. The states of a transfer are drawn in docs/protocols.md.
///
/// Messages: node_drain, node_undrain, node_transfer, node_release and
/// transfer_query. Errors: unknown_node, unknown_cell, unknown_task (no such
/// transfer), conflict (the node is departing or reserved, or its instances may
/// not go), unreachable, timeout and unresolved (the end is not known in time).
namespace roscell {

/// Takes up what an earlier run of the coordinator has stored.
void restore_drains(coordinator_pointer self);

caf::result<node_drained> drain_node(coordinator_pointer self,
                                     const node_drain& request);
caf::result<node_undrained> undrain_node(coordinator_pointer self,
                                         const node_undrain& request);

/// Moves what is due.
void go_on_draining(coordinator_pointer self);

// A node is let go, to another cell or to independence.

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

// The steps of one transfer, in their order.

struct transfer_order {
  std::string node;
  std::string target; ///< Name of the cell; empty: independence.
  instance_policy instances = instance_policy::refuse;
  join_origin origin = join_origin::chosen;
};

/// Why a node of this cell cannot go, if so.
std::optional<failure> objection_to(coordinator_pointer self,
                                    const transfer_order& order);

/// The part of it that instances are: those of deploying tasks count.
std::optional<failure> objection_to_instances(const cell_coordinator_state& st,
                                              const transfer_order& order);

/// Lets a node of this cell go. `done` hears of the outcome, or that it cannot
/// be known in time.
void start_transfer(coordinator_pointer self, const transfer_order& order,
                    transfer_done done);

/// Has the target cell keep a place for the node of a transfer, then calls
/// `next`, unless the transfer has ended meanwhile. A release needs none.
void reserve_target(coordinator_pointer self, const std::string& id,
                    const std::function<void()>& next);

/// Writes down that the node is told to go, and tells it.
void order_switch(coordinator_pointer self, const std::string& id,
                  join_origin origin);

/// Ends or moves what is bound to the node of a transfer, of deploying tasks
/// too, then calls `next`, unless the transfer has ended meanwhile. What fails
/// calls the transfer off.
void clear_instances(coordinator_pointer self, const std::string& id,
                     instance_policy policy, const std::function<void()>& next);

} // namespace roscell
