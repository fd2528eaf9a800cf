#pragma once

#include "messages/actors.hpp"
#include "messages/event.hpp"

#include <string>
#include <vector>

namespace roscell {

/// Asks an actor what it knows. Every actor of a node answers.
struct state_query {
  static constexpr auto fields() {
    return field_list{};
  }
};

/// An actor's state as a JSON object.
struct actor_state {
  std::string json_text;

  static constexpr auto fields() {
    return field_list{required("state", &actor_state::json_text)};
  }
};

/// An event to be numbered, dated and kept.
struct record_event {
  std::string what;    ///< A past participle: "node_joined".
  std::string subject; ///< Whom it concerns: a node, task or instance.
  std::string data;    ///< JSON object, may be empty.

  static constexpr auto fields() {
    return field_list{required("what", &record_event::what),
                      required("subject", &record_event::subject),
                      required("data", &record_event::data)};
  }
};

/// Wants every event after `since` that is still kept, then each new one.
struct subscribe_events {
  event_listener_actor listener;
  uint64_t since = 0;

  static constexpr auto fields() {
    return field_list{required("listener", &subscribe_events::listener),
                      required("since", &subscribe_events::since)};
  }
};

/// Wants every event after `since` that is still kept, and no more.
struct kept_events_query {
  uint64_t since = 0;

  static constexpr auto fields() {
    return field_list{required("since", &kept_events_query::since)};
  }
};

struct kept_events {
  std::vector<event> events; ///< The oldest first.

  static constexpr auto fields() {
    return field_list{required("events", &kept_events::events)};
  }
};

} // namespace roscell
