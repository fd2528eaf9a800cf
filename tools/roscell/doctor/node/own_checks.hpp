#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/checks.hpp"

#include <memory>
#include <string>
#include <vector>

namespace roscell::cli {

/// Whether a check is of what a node has for itself: its folders, its user's
/// rights, its limits. Where a node runs, only it knows them.
bool is_own_check(const std::string& name);

/// What the node finds that runs here. It is asked once, by the first of these
/// checks.
std::vector<check> own_checks(const std::shared_ptr<const node_client>& node,
                              const std::vector<check>& checks);

} // namespace roscell::cli
