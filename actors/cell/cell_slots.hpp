#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// How the CELL COORDINATOR fills its cell: it grants slots to nodes that look
/// for one, balances cells, and forms a cell of named nodes. The slots stand in
/// the slot table (`st.slots`); the coordinator with the lowest UUID grants and
/// balances for the whole site, so that nodes that come at one moment spread
/// evenly.
///
/// Messages: place_request, place_reservation, member_surrender and
/// cell_formation, each answered by the function of its group. Errors: conflict
/// (nothing takes the node, or it is departing), unreachable (the cell that was
/// to take it has gone) and unknown_node (none of that name is visible).
namespace roscell {

/// Whether this coordinator is the slot arbiter of the site.
bool is_slot_arbiter(const cell_coordinator_state& st);

/// Answers when the sizes of the cells that have just appeared are known, or
/// when that takes too long.
caf::result<place_granted> grant_slot(coordinator_pointer self,
                                      const place_request& request);

caf::result<place_reserved> reserve_slot(coordinator_pointer self,
                                         const place_reservation& request);

/// The same for this coordinator itself. Errors: conflict.
caf::expected<place_reserved> reserve_here(coordinator_pointer self,
                                           const place_reservation& request);

/// Grants the slots that have waited for sizes which are known now.
void grant_awaited_slots(coordinator_pointer self);

/// What counts when a slot is granted in that cell, or cells are balanced.
int64_t size_of(const cell_coordinator_state& st, const std::string& uuid,
                const peer_entry& peer);

/// Drops the slots that nobody has taken in time, and grants those that have
/// waited for sizes for too long.
void settle_overdue_slots(coordinator_pointer self);

// Cells are balanced after one has appeared or died, or a slot was not taken.

/// A cell as the plan sees it.
struct cell_size {
  std::string uuid;
  std::string cell;
  int64_t size = 0;
};

/// So many members of one cell are to go to another one.
struct cell_move {
  std::string from; ///< UUIDs.
  std::string to;
  int64_t count = 0;
};

/// The fewest moves after which sizes differ by at most one. The largest cells
/// keep the remainder, so nobody moves without need.
std::vector<cell_move> plan_balancing(std::vector<cell_size> cells);

/// Balances the cells if it is time and this is the slot arbiter.
void balance_if_due(coordinator_pointer self);

caf::result<members_surrendered>
hand_over_members(coordinator_pointer self, const member_surrender& request);

// A cell is formed of nodes by their names.

caf::result<cell_formed> form_cell(coordinator_pointer self,
                                   const cell_formation& request);

} // namespace roscell
