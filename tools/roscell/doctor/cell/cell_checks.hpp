#pragma once

#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <functional>
#include <string>
#include <vector>

namespace roscell::cli {

/// Told what is being done, for who waits.
using check_progress = std::function<void(const std::string&)>;

/// What is looked at in a whole cell, by many at once; they can be listed only.
const std::vector<check>& cell_checks();
bool is_cell_check(const std::string& name);

/// Has every node of the cell that `node` is in look at its host, and try to
/// reach every other one.
/// @param own name of the node whose host has been looked at already; empty:
/// none.
/// @param only names of the checks that are wanted; empty: all. What is broken
/// is told anyway.
findings check_cell(const node_client& node, const std::string& own,
                    const std::vector<std::string>& only,
                    const check_progress& report_progress);

} // namespace roscell::cli
