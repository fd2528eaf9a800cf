#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>

/// Those who wait for a node to register with this cell.
namespace roscell {

/// @param done called once: when the node has registered, will not, or took too
/// long.
void await_arrival(coordinator_pointer self, const std::string& uuid,
                   completion_handler done);

/// Tells those who wait for that node that it has joined, or why it will not.
void settle_arrivals(coordinator_pointer self, const std::string& uuid,
                     const completion& how);

/// Gives up waiting for nodes that are overdue.
void settle_overdue_arrivals(coordinator_pointer self);

} // namespace roscell
