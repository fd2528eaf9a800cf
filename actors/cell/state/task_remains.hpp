#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// Of a task that is no more what may run on, where its node is away, is
/// remembered until it surely has ended: also over restarts of the coordinator.
/// Until then no step of that name is started.
namespace roscell {

/// What the store is to have of a task that is no more: nothing, or where it
/// may run on.
store_record record_of_remains(coordinator_pointer self,
                               const std::string& task);

/// Forgets what its fence has ended, and removes what is remembered of tasks
/// that surely run nowhere by now. A task that was begun anew has a record of
/// its own.
void forget_past_remains(coordinator_pointer self);

} // namespace roscell
