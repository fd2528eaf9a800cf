#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>
#include <string>
#include <vector>

/// How the CELL COORDINATOR has instances removed. One that lives and did not
/// do it in time is asked again.
namespace roscell {

/// Removes what a task has on active nodes, and room that is kept for it on
/// others, then calls `done` with the nodes that have not said that they did.
void remove_everywhere(
    coordinator_pointer self, const std::string& task,
    const std::vector<std::string>& also_on,
    const std::function<void(const std::vector<std::string>& away)>& done);

/// Removes one instance, then calls `done`.
void remove_instance(coordinator_pointer self, const overdue_removal& what,
                     const std::function<void()>& done);

void ask_overdue_removals(coordinator_pointer self);

} // namespace roscell
