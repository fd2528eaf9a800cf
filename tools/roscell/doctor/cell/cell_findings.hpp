#pragma once

#include "messages/insight/reach.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <map>
#include <string>
#include <vector>

/// What each node of a cell reaches of the others, and what they differ in.
namespace roscell::cli {

/// The nodes of a cell that answer.
struct reached_cell {
  std::string coordinator;
  std::map<std::string, reach_opened> nodes; ///< By name.
};

/// The address of its host; what it says itself where that is none.
std::string host_of(const reach_opened& x);

/// What one node has tried. What its way back needs, too, is tried by the other
/// one.
findings judge_reach(const reach_report& reported, const reached_cell& cell);

/// Nodes of other versions than the coordinator's.
findings judge_versions(const reached_cell& cell);

/// When a node's clock was read.
struct clock_reading {
  std::string node;
  double offset_ms = 0;      ///< To the clock of who has asked.
  double uncertainty_ms = 0; ///< Half the round trip.
};

/// How far the clocks are from the coordinator's, or from that of most nodes
/// where these agree with each other and not with it.
findings judge_clocks(const std::vector<clock_reading>& all,
                      const reached_cell& cell);

} // namespace roscell::cli
