#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/failure.hpp"

#include <optional>
#include <string>

/// What others who work on a task ask and tell of its update. The update itself
/// is in update_run.hpp.
namespace roscell {

/// Why nothing else is done to the instances of a task; null: it is not being
/// updated.
std::optional<failure> why_updating(const cell_coordinator_state& st,
                                    const std::string& task);

/// A task is being ended: its update goes on no more. What it waits for finds
/// that out when it comes.
void drop_update(coordinator_pointer self, const std::string& task);

} // namespace roscell
