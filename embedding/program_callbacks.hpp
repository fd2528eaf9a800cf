#pragma once

#include "actors/core/actor_context.hpp"
#include "messages/actors.hpp"
#include "roscell/node_calls.hpp"

#include <memory>

namespace roscell::embedding {

/// Tells the program around a node of its events. It has a thread of its own,
/// so that what the program does then holds up no actor of the node.
struct program_callbacks_state {
  static constexpr const char* name = "program-callbacks";
};

/// Ends with the event log. What it hears: event.
event_listener_actor::behavior_type program_callbacks(
    event_listener_actor::stateful_pointer<program_callbacks_state> self,
    const event_log_actor& events,
    const std::shared_ptr<const node_callbacks>& calls);

/// Whether a program wants to hear anything.
bool wants_to_hear(const node_callbacks& calls);

/// An event in one line: "node_joined 'arm' address=10.0.0.2:8420".
std::string log_line(const event& e);

} // namespace roscell::embedding
