#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>

namespace roscell {

/// Has the target cell keep a place for the node of a transfer, then calls
/// `next`, unless the transfer has ended meanwhile. A release needs none.
void reserve_target(coordinator_pointer self, const std::string& id,
                    const std::function<void()>& next);

/// Writes down that the node is told to go, and tells it.
void order_switch(coordinator_pointer self, const std::string& id,
                  join_origin origin);

} // namespace roscell
