#pragma once

#include "messages/insight/node_cost.hpp"
#include "tools/roscell/view/views.hpp"

#include <string>

namespace roscell::cli {

/// What each node costs, a row for minute, hour and day; below them why there
/// are none of a node.
std::string cost_view(const cost_report& report, const view_style& style);

} // namespace roscell::cli
