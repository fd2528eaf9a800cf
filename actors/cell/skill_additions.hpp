#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <caf/result.hpp>

/// The cell's skills: builds that somebody has added, which go to each node
/// that needs them.
namespace roscell {

/// Takes up those that an earlier run has stored.
void restore_builds(coordinator_pointer self);

/// Fetches the build from the node that has it, has a second node do so, and
/// then makes it one of the cell's. Errors: see `cell_coordinator_actor`.
caf::result<skill_added> add_skill(coordinator_pointer self,
                                   const skill_addition& request);

/// What is running of them, or is on its way, is not removed.
caf::result<skill_removed> remove_skill(coordinator_pointer self,
                                        const skill_removal& request);

/// Has a node fetch one of the cell's builds, which it may let go again.
caf::result<skill_pulled> pull_skill(coordinator_pointer self,
                                     const skill_pull& request);

/// Has a node let go what was removed while it had it.
void release_remains(coordinator_pointer self, const std::string& node);

/// The table of the store that has the cell's builds.
constexpr const char* builds_table = "builds";
/// Of builds that nodes have to let go, in the same way.
constexpr const char* remains_table = "removed_builds";

} // namespace roscell
