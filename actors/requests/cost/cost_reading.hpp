#pragma once

#include "actors/core/metric_table.hpp"
#include "messages/insight/node_cost.hpp"

#include <memory>
#include <vector>

namespace roscell {

/// What the node's process has cost so far.
struct cost_reading {
  double cpu_s = 0;
  double pss_bytes = 0; ///< At this moment.
  double written_bytes = 0;
  std::vector<peer_traffic> peers;
};

/// Reads the process, and from the table what went over sessions; null: nothing
/// did.
cost_reading read_cost(const std::shared_ptr<metric_table>& table);

} // namespace roscell
