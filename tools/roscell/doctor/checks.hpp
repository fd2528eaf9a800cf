#pragma once

#include "tools/roscell/doctor/check.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace roscell::cli {

/// What a host can see by itself.
const std::vector<check>& host_checks();

/// What a node that runs here finds on its host.
/// @param config as the node was started with, its address included.
findings check_own_host(const node_config& config);

} // namespace roscell::cli
