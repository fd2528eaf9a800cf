#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/core/alarm.hpp"
#include "actors/node/event_series.hpp"
#include "messages/messages.hpp"

#include <deque>
#include <optional>
#include <vector>

namespace roscell {

/// Where the events of this node are kept beyond its end.
struct event_log_setup {
  node_history_actor history; ///< None in tests that do not care.
  uint64_t first_number = 0;  ///< Numbers begin above it.
};

/// Owns the node's events: it numbers them, keeps the newest, hands them on,
/// and has them written in batches. Those that repeat themselves without end
/// are counted.
struct event_log_state {
  static constexpr const char* name = "event-log";

  node_history_actor history;
  uint64_t last_sequence = 0;
  std::deque<event> kept;
  std::vector<event_listener_actor> listeners;
  refusal_gate gate;
  event_series series;
  std::deque<event> unwritten; ///< Of those that are kept.
  bool writing = false;        ///< A batch is under way.
  bool has_problem = false;    ///< The last batch could not be written.
  bool ending = false;         ///< The node ends: what is left is written.
  std::optional<alarm::time_point> batch_due;
  alarm timer;
};

/// The EVENT LOG. Messages: messages/inside/introspection.hpp. It ends the
/// history that it was given when it has written all.
event_log_actor::behavior_type
event_log(event_log_actor::stateful_pointer<event_log_state> self,
          const event_log_setup& setup);

// INTERNAL to the event log: how what it keeps gets to the disk.

using event_log_pointer = event_log_actor::stateful_pointer<event_log_state>;

/// It is written with those that come soon after it.
void add_to_batch(event_log_pointer self, const event& x);

/// Has written what waits. Where the node ends the log ends behind it.
void write_batch(event_log_pointer self);

} // namespace roscell
