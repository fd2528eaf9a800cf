#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>

namespace roscell {

/// Ends or moves what is bound to the node of a transfer, of deploying tasks
/// too, then calls `next`, unless the transfer has ended meanwhile. What fails
/// calls the transfer off.
void clear_instances(coordinator_pointer self, const std::string& id,
                     instance_policy policy, const std::function<void()>& next);

} // namespace roscell
