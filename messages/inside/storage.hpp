#pragma once

#include "messages/event.hpp"
#include "messages/inside/introspection.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell {

/// The tables of a node's database. A record is the JSON of one struct:
///
/// | table | key | struct |
/// |---|---|---|
/// | identity | node, membership | node_identity, membership_record |
/// | identity | incarnation | a number; coordinators |
/// | instances | instance | instance_row |
/// | tasks, members, transfers | see the coordinator's tables | coordinators |
///
/// A field that is new in such a struct needs a default: records of before lack
/// it. Reading them: actors/node/node_data.cpp. The file itself:
/// actors/edge/disk/sqlite_store.cpp.

/// Writes one record durably; an empty value removes it.
struct store_record {
  std::string table;
  std::string key;
  std::string value; ///< JSON text.
  /// A disk that cannot be written is no reason to refuse: the record then
  /// stays in memory and is written when there is room. For what a node must
  /// be able to do even then: to belong to a cell, and to end instances.
  bool may_wait = false;

  static constexpr auto fields() {
    return field_list{required("table", &store_record::table),
                      required("key", &store_record::key),
                      required("value", &store_record::value),
                      optional("may_wait", &store_record::may_wait)};
  }
};

/// Writes several records in one transaction: all of them or none. The last
/// one of a key counts. They wait only if all of them may.
struct store_records {
  std::vector<store_record> records;

  static constexpr auto fields() {
    return field_list{required("records", &store_records::records)};
  }
};

struct record_stored {
  static constexpr auto fields() {
    return field_list{};
  }
};

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
