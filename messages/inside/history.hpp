#pragma once

#include "messages/event.hpp"

#include <cstdint>
#include <vector>

namespace roscell {

/// Events to be written to the node's history, the oldest first.
struct event_batch {
  std::vector<event> events;
  /// None will follow: numbers go on right behind them after the next start.
  bool last = false;

  static constexpr auto fields() {
    return field_list{required("events", &event_batch::events),
                      optional("last", &event_batch::last)};
  }
};

/// They are on the disk.
struct events_written {
  /// Numbers up to this one are set aside: none of them is given again after a
  /// loss of power.
  uint64_t set_aside = 0;

  static constexpr auto fields() {
    return field_list{required("set_aside", &events_written::set_aside)};
  }
};

/// Wants a part of the events of the past: `kept_events`, an empty one behind
/// the end.
struct past_events_query {
  uint64_t since = 0;        ///< Those after this number,
  int64_t since_unix_ms = 0; ///< from the first one on that is not older.
  uint64_t newest = 0;       ///< Not 0: of these only so many, the newest.

  static constexpr auto fields() {
    return field_list{
        required("since", &past_events_query::since),
        required("since_unix_ms", &past_events_query::since_unix_ms),
        required("newest", &past_events_query::newest)};
  }
};

/// An event: the log of an instance has been put into the history.
struct log_kept {
  static constexpr auto fields() {
    return field_list{};
  }
};

} // namespace roscell
