#pragma once

#include "messages/instance.hpp"

#include <vector>

namespace roscell {

/// Puts the steps of one task into the order in which data flow through them:
/// each behind all that it gets something from, steps of which this says
/// nothing as they were. Where data flow in a circle, what leads back does not
/// count. Pictures of a task are drawn in this order.
void sort_by_flow(std::vector<instance_row>& steps);

} // namespace roscell
