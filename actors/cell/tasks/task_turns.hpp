#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <functional>

/// Whatever is placed takes its turn, so that two never count on the same
/// resources: a turn lasts until what was placed is held.
namespace roscell {

/// Calls `begin` with the number of the turn when it has come: at once when
/// nobody has it.
void take_turn(coordinator_pointer self, const caf::actor_addr& owner,
               const std::function<void(uint64_t)>& begin);

void end_turn(coordinator_pointer self, uint64_t number);

/// An owner that is gone waits no more.
void leave_line(coordinator_pointer self, const caf::actor_addr& owner);

} // namespace roscell
