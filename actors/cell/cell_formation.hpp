#pragma once

#include "actors/cell/cell_coordinator.hpp"

/// How the CELL COORDINATOR brings nodes in by their names.
namespace roscell {

caf::result<cell_formed> form_cell(coordinator_pointer self,
                                   const cell_formation& request);

/// Tells those who wait for that node that it has joined, or why it will not.
void settle_arrivals(coordinator_pointer self, const std::string& uuid,
                     const failure* why);

/// Gives up waiting for nodes that are overdue.
void settle_overdue_arrivals(coordinator_pointer self);
std::chrono::steady_clock::time_point
next_arrival_deadline(coordinator_pointer self);

} // namespace roscell
