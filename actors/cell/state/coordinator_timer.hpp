#pragma once

#include "actors/cell/state/coordinator_state.hpp"

namespace roscell {

/// Sets the CELL COORDINATOR's timer to whatever is due first.
void set_timer(coordinator_pointer self);

/// The number of a tick that no timer has sent.
constexpr uint64_t at_once = 0;

/// Has what is due looked at once the present message has been handled.
void wake(coordinator_pointer self);

/// Something may have changed for sets of tasks: they are looked at once the
/// present message has been handled.
void look_at_sets(coordinator_pointer self);

/// The same, also where there is no set any more: tasks of one may be left.
void wake_for_sets(coordinator_pointer self);

/// Has the sizes of the cells looked at a little later, when things have come
/// to rest.
void arm_balance(coordinator_pointer self);

} // namespace roscell
