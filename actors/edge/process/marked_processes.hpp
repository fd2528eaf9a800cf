#pragma once

#include <string>

namespace roscell {

/// Kills every process of this host that was started with the environment
/// variable `name` of this value, and waits a moment for their end: a killed
/// one may have started another one meanwhile, so it looks again until there is
/// none, nor one that is about to become another program. Finds what has a
/// session and a parent of its own, but not what has dropped the variable.
/// Returns how many it has killed. Blocks for a second at most.
int kill_marked_processes(const std::string& name, const std::string& value);

} // namespace roscell
