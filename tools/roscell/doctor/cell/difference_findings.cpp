#include "tools/roscell/doctor/cell/cell_findings.hpp"
#include "tools/roscell/doctor/command_text.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cmath>

namespace roscell::cli {

findings judge_versions(const reached_cell& cell) {
  findings result;
  const auto base = cell.nodes.find(cell.coordinator);
  if (base == cell.nodes.end())
    return result;
  const auto& version = base->second.version;
  for (const auto& [name, x] : cell.nodes)
    if (x.version != version)
      result.push_back(
          named_finding("cell-versions", "cell",
                        {judgement::warning,
                         name + " is of version " + x.version
                             + ", its coordinator of " + version,
                         "what only one of them knows cannot be used",
                         on_host(host_of(x), "roscell --version")}));
  if (result.empty())
    result.push_back(
        named_finding("cell-versions", "cell",
                      {judgement::ok, std::to_string(cell.nodes.size())
                                          + " nodes of version " + version}));
  return result;
}

namespace {

// A frame of a camera; what is more makes ages wrong, and transforms fail.
constexpr double tolerable_ms = 33;

/// How far `x` is ahead of `base` for sure, whichever way.
double sure_difference(const clock_reading& x, const clock_reading& base) {
  return std::abs(x.offset_ms - base.offset_ms) - x.uncertainty_ms
         - base.uncertainty_ms;
}

/// By whose clock the others are judged: one that more than half of all nodes
/// agree with, the coordinator's if it is one of these, and its own if no clock
/// is. null without a coordinator's.
const clock_reading* base_of(const std::vector<clock_reading>& all,
                             const std::string& coordinator) {
  const clock_reading* own = nullptr;
  const clock_reading* most = nullptr;
  for (const auto& x : all) {
    const auto agree = std::count_if(all.begin(), all.end(), [&](auto& y) {
      return sure_difference(x, y) <= tolerable_ms;
    });
    const bool by_most = 2 * static_cast<size_t>(agree) > all.size();
    if (x.node == coordinator)
      own = &x;
    if (by_most && (!most || x.node == coordinator))
      most = &x;
  }
  return own && most ? most : own;
}

} // namespace

findings judge_clocks(const std::vector<clock_reading>& all,
                      const reached_cell& cell) {
  constexpr double hopeless_ms = 1000;
  findings result;
  const auto* base = base_of(all, cell.coordinator);
  if (!base)
    return result;
  const bool is_own = base->node == cell.coordinator;
  double most = 0;
  for (const auto& x : all) {
    const auto offset = x.offset_ms - base->offset_ms;
    const auto sure = sure_difference(x, *base);
    most = std::max(most, std::abs(offset));
    const auto host = cell.nodes.find(x.node);
    if (sure <= tolerable_ms || host == cell.nodes.end())
      continue;
    result.push_back(named_finding(
        "cell-clocks", "cell",
        {sure > hopeless_ms ? judgement::broken : judgement::warning,
         x.node + "'s clock is " + format_number(std::abs(offset) / 1000)
             + " s " + (offset > 0 ? "ahead of" : "behind") + " "
             + (is_own ? "the coordinator's" : "that of most nodes"),
         "ages of data are wrong, and programs drop transforms and messages as "
         "too old or from the future",
         on_host(host_of(host->second), "sudo chronyc makestep")}));
  }
  if (result.empty())
    result.push_back(named_finding(
        "cell-clocks", "cell",
        {judgement::ok, "clocks differ by " + format_number(most)
                            + " ms at most, as far as can be told"}));
  return result;
}

} // namespace roscell::cli
