#pragma once

#include "actors/core/actor_context.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/requests/rest_routes.hpp"
#include "messages/instance.hpp"
#include "messages/messages.hpp"

#include <memory>
#include <optional>
#include <string>
#include <variant>

namespace roscell {

/// Puts the parts of one log together, each line behind its time, where the
/// parts tell times: "2026-11-22T17:01:02.345Z a line". A line that comes in
/// several parts gets its time once, one whose time is not known a "-".
class timed_log {
public:
  /// What is to be shown of the next part, byte by byte as it was logged.
  std::string add(const log_excerpt& part);

private:
  bool in_line_ = false; ///< The part before has ended within a line.
};

// Answers without an end: the event stream, and logs that are followed.

/// An EVENT STREAM writes each event as one server-sent event.
using event_stream_actor = introspected_actor::extend<caf::reacts_to<event>>;

/// Starts one that ends when its client goes.
void start_event_stream(caf::actor_system& system, const actor_context& context,
                        const std::shared_ptr<http_stream>& stream,
                        uint64_t since);

/// Which of the events that have been are wanted: those in memory, or a part of
/// those on the disk.
using event_question = std::variant<kept_events_query, past_events_query>;

/// Answers with these, in the same form, and with no others.
void send_kept_events(caf::actor_system& system, const actor_context& context,
                      const responder& answer, const event_question& which);

struct log_stream_state {
  static constexpr const char* name = "log-stream";

  request_router_actor router;
  log_stream_request request;
  timed_log timed;
  std::optional<responder> answer;     ///< Set before anything else happens.
  std::shared_ptr<http_stream> stream; ///< Made with the first excerpt.
};

/// A LOG STREAM asks for one excerpt after the other; each question waits at
/// the instance's node until there is something to say. Speaks to the router
/// like any other client.
introspected_actor::behavior_type
log_stream(introspected_actor::stateful_pointer<log_stream_state> self,
           const request_router_actor& router,
           const log_stream_request& request, const responder& answer);

} // namespace roscell
