#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <functional>
#include <string>

/// Where nodes are, as the CELL COORDINATOR learns it: a node that turns up
/// elsewhere or comes back ends its transfer and settles who waits for it; and
/// which node of which cell an operator means by a name. The state is in the
/// registry, `st.transfers`, `st.slots` (arrivals) and `st.peers`. Errors of
/// who waits: conflict, unreachable and unresolved; of names: conflict (several
/// cells have one), unknown_node and unknown_cell.
namespace roscell {

/// An event: the node has this epoch in another cell, or in none if `cell` is
/// empty. Its row here is out of date.
void on_node_elsewhere(coordinator_pointer self, const std::string& uuid,
                       int64_t epoch, const std::string& cell);

/// An event: the node has registered here, maybe in the middle of a transfer.
void on_node_returned(coordinator_pointer self, const std::string& uuid);

/// An event: a node with a departing row has no session any more. It is lost,
/// unless it has been told to go: then where it turns up tells the rest. Gives
/// whether it is lost.
bool fail_departing_node(coordinator_pointer self, registry_entry& entry,
                         const std::string& reason);

/// Tells of a row that has become `lost`.
void publish_node_lost(coordinator_pointer self, const registry_entry& entry);

// How a transfer ends. Each does nothing when it has ended already.

/// Writes the end down and tells all who wait how it went. Of what has failed
/// it is told that tasks have been terminated nevertheless.
void end_transfer(coordinator_pointer self, const std::string& id,
                  transfer_state state, const std::string& reason,
                  const completion& how);

/// The node stays a member: its row is active again, or lost if it is away.
void call_off_transfer(coordinator_pointer self, const std::string& id,
                       const failure& why);

// Those who wait for a node to register with this cell.

/// @param done called once: when the node has registered, will not, or took too
/// long.
void await_arrival(coordinator_pointer self, const std::string& uuid,
                   completion_handler done);

/// Tells those who wait for that node that it has joined, or why it will not.
void settle_arrivals(coordinator_pointer self, const std::string& uuid,
                     const completion& how);

/// Gives up waiting for nodes that are overdue.
void settle_overdue_arrivals(coordinator_pointer self);

// Which node an operator means by a name: names are unique in a cell only.

/// Where a node is that was named to this coordinator.
struct named_node {
  peer_actor holder;  ///< Invalid: no other cell that is known has it.
  member_claim claim; ///< Of the holder.
  std::string cell;   ///< The same.
  failure why;        ///< If it cannot be told; else without a message.
};

/// The one node of that name that other cells have.
named_node find_elsewhere(const cell_coordinator_state& st,
                          const std::string& node);

/// Names are the asked cell's first. A node of another cell is meant if that
/// cell is named too, or if it is the only one of the name and this cell has
/// let none of it go.
/// @param cell the cell that the node is in; empty: not named.
named_node find_named_node(const cell_coordinator_state& st,
                           const std::string& node, const std::string& cell);

} // namespace roscell
