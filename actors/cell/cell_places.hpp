#pragma once

#include "actors/cell/cell_coordinator.hpp"

/// How the CELL COORDINATOR gives out places, so that nodes that come at the
/// same moment spread evenly. The one with the lowest UUID does it for all.
namespace roscell {

/// Whether this coordinator is the one that gives out places.
bool gives_places(coordinator_pointer self);

caf::result<place_granted> grant_place(coordinator_pointer self,
                                       const place_request& request);

caf::result<place_reserved> reserve_place(coordinator_pointer self,
                                          const place_reservation& request);

/// The same for this coordinator itself. Errors: conflict.
caf::expected<place_reserved> reserve_here(coordinator_pointer self,
                                           const place_reservation& request);

/// Drops the places that nobody has taken in time.
void drop_overdue_places(coordinator_pointer self);

} // namespace roscell
