#pragma once

#include "messages/codec/json_codec.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell {

/// An event that has happened on this node. `type` is one of the words that
/// docs/protocols.md lists: "node_joined", "instance_changed", ...
struct event {
  static constexpr const char* type = "event";
  /// Counts on over restarts of the node; a number is never given twice. Of a
  /// passing event: that of the last one that is kept.
  uint64_t sequence = 0;
  int64_t time_unix_ms = 0;
  std::string what;    ///< The event, a past participle: "node_joined".
  std::string subject; ///< Whom it concerns: a node, task or instance.
  std::string data;    ///< JSON object with the particulars, may be empty.
  /// One of a series that repeats itself: who listens gets it, but it is not
  /// kept, only counted.
  bool passing = false;

  static constexpr auto fields() {
    return field_list{required("sequence", &event::sequence),
                      required("time_unix_ms", &event::time_unix_ms),
                      required("event", &event::what),
                      required("subject", &event::subject),
                      raw_json("data", &event::data),
                      optional("passing", &event::passing)};
  }
};

} // namespace roscell
