#pragma once

#include "actors/house/alarm.hpp"
#include "actors/house/house.hpp"
#include "actors/node/refusal_gate.hpp"
#include "messages/messages.hpp"

#include <deque>
#include <vector>

namespace roscell {

/// Owns the node's facts: it numbers them, keeps the newest and hands them on.
struct event_log_state {
  static constexpr const char* name = "event-log";

  uint64_t last_sequence = 0;
  std::deque<event> kept;
  std::vector<event_listener_actor> listeners;
  refusal_gate gate;
  alarm timer;
};

/// The EVENT LOG. Messages: messages/inside/introspection.hpp.
event_log_actor::behavior_type
event_log(event_log_actor::stateful_pointer<event_log_state> self);

} // namespace roscell
