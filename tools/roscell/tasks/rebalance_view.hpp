#pragma once

#include "messages/rebalance.hpp"
#include "tools/roscell/view/table.hpp"

#include <string>

namespace roscell::cli {

/// The moves with their gains, and the totals before and after them.
std::string rebalance_view(const cell_rebalanced& report,
                           const text_style& style);

} // namespace roscell::cli
