#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR grants slots, so that nodes that come at the
/// same moment spread evenly. The one with the lowest UUID does it for all.
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

/// Gives out the places that have waited for sizes which are known now.
void grant_awaited_slots(coordinator_pointer self);

/// What counts when a slot is granted in that cell, or cells are balanced.
int64_t size_of(const cell_coordinator_state& st, const std::string& uuid,
                const peer_entry& peer);

/// Drops the places that nobody has taken in time, and gives out those that
/// have waited for sizes for too long.
void settle_overdue_slots(coordinator_pointer self);

} // namespace roscell
