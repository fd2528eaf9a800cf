#pragma once

#include "messages/event.hpp"

#include <caf/replies_to.hpp>
#include <caf/typed_actor.hpp>

#include <string>
#include <vector>

namespace roscell {

/// Asks an actor what it knows. Every actor of the house answers.
struct state_query {
  static constexpr auto fields() {
    return std::make_tuple();
  }
};

/// An actor's state as a JSON object.
struct actor_state {
  std::string json_text;

  static constexpr auto fields() {
    return std::make_tuple(required("state", &actor_state::json_text));
  }
};

/// The clause that every typed handle includes.
using introspected_actor =
    caf::typed_actor<caf::replies_to<state_query>::with<actor_state>>;

/// A fact to be numbered, dated and kept.
struct record_event {
  std::string what;    ///< A past participle: "node_joined".
  std::string subject; ///< Whom it concerns: a node, task or instance.
  std::string data;    ///< JSON object, may be empty.

  static constexpr auto fields() {
    return std::make_tuple(required("what", &record_event::what),
                           required("subject", &record_event::subject),
                           required("data", &record_event::data));
  }
};

/// Gets facts as they happen, in the order of their sequence numbers.
using event_listener_actor = caf::typed_actor<caf::reacts_to<event>>;

/// Wants every event after `since` that is still kept, then each new one.
struct subscribe_events {
  event_listener_actor listener;
  uint64_t since = 0;

  static constexpr auto fields() {
    return std::make_tuple(required("listener", &subscribe_events::listener),
                           required("since", &subscribe_events::since));
  }
};

/// The EVENT LOG: the node's one stream of facts.
using event_log_actor = introspected_actor::extend<
    // Gives the fact the next sequence number and tells the listeners.
    caf::reacts_to<record_event>,
    // Adds a listener until it ends.
    caf::reacts_to<subscribe_events>>;

} // namespace roscell
