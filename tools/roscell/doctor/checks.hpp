#pragma once

#include "tools/roscell/doctor/checked_host.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace roscell::cli {

/// Something that can be looked at by itself.
struct check {
  const char* name;
  const char* area;  ///< "network", "host" or "node".
  const char* about; ///< What it looks at.
  std::function<findings(const checked_host&)> run_check;
};

/// What a host can see by itself.
const std::vector<check>& host_checks();

/// The longest that a check is waited for.
constexpr std::chrono::seconds longest_check{10};

/// Told the checks that still look, when it has taken so long that somebody may
/// wonder.
using still_checking = std::function<void(const std::vector<std::string>&)>;

/// Makes all checks at once, and gives what they found in the order of the
/// checks. One that does not end, on a disk that does not answer, say, is a
/// finding itself, and is left to itself; until it ends it is not begun again.
findings run_checks(const std::vector<check>& checks, const checked_host& host,
                    const still_checking& report_progress,
                    std::chrono::milliseconds limit = longest_check);

/// What a node that runs here finds on its host.
/// @param config as the node was started with, its address included.
findings check_own_host(const node_config& config);

} // namespace roscell::cli
