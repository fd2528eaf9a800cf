#pragma once

#include "tools/roscell/doctor/examined_host.hpp"
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
  std::function<findings(const examined_host&)> look;
};

/// What a host can see by itself.
const std::vector<check>& host_checks();

/// The longest that a check is waited for.
constexpr std::chrono::seconds longest_look{10};

/// Told the checks that still look, when it has taken so long that somebody may
/// wonder.
using still_looking = std::function<void(const std::vector<std::string>&)>;

/// Makes all checks at once, and gives what they found in the order of the
/// checks. One that does not end, on a disk that does not answer, say, is a
/// finding itself, and is left to itself; until it ends it is not begun again.
findings run_checks(const std::vector<check>& checks, const examined_host& host,
                    const still_looking& tell,
                    std::chrono::milliseconds limit = longest_look);

/// What a node that runs here finds on its host.
/// @param config as the node was started with, its address included.
findings examine_own_host(const node_config& config);

} // namespace roscell::cli
