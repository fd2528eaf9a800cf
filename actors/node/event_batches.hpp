#pragma once

#include "actors/node/event_log.hpp"

/// INTERNAL to the event log: how what it keeps gets to the disk.
namespace roscell {

using event_log_pointer = event_log_actor::stateful_pointer<event_log_state>;

/// It is written with those that come soon after it.
void add_to_batch(event_log_pointer self, const event& x);

/// Has written what waits. Where the node ends the log ends behind it.
void write_batch(event_log_pointer self);

} // namespace roscell
