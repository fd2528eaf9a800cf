#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/requests/metrics/exposition.hpp"
#include "actors/requests/rest_builds.hpp"
#include "messages/failure.hpp"
#include "messages/inside/storage.hpp"
#include "messages/instance.hpp"

#include <cstdint>
#include <string>
#include <variant>

namespace roscell {

/// `GET /healthz`: the node lives.
struct health_check {};

/// `GET /metrics`: in the text format that the client prefers.
struct metrics_request {
  exposition_format format = exposition_format::text;
};

/// `GET /v1/events?since=N&follow=0`: server-sent events.
struct event_stream_request {
  uint64_t since = 0;
  bool follow = true; ///< Else those in memory, and no more.
};

/// `GET /v1/events?past=1&since=N&since_unix_ms=T&newest=N`: a part of what is
/// on the disk, in the same form; an empty one is the end.
struct past_events_request {
  past_events_query query;
};

/// `GET /v1/instances/{id}/logs?tail=N&offset=N&times=1&previous=1&follow=1`:
/// plain text.
struct log_stream_request {
  log_query query;
  bool follow = false;
};

/// Everything else is one JSON request for the router.
struct json_request {
  std::string text;
  std::string only; ///< The one message type that is allowed; empty: any.
  std::string from; ///< Who asks.
  std::string role; ///< What he may at the site; empty: all.
};

/// What an HTTP request asks for, or why it asks for nothing.
using rest_route =
    std::variant<json_request, event_stream_request, past_events_request,
                 log_stream_request, health_check, metrics_request,
                 build_request, failure>;

/// The paths of the REST interface; docs/operations.md lists them.
rest_route route_of(const http_request& request);

/// HTTP status of a refusal.
int http_status(error_code code);

} // namespace roscell
