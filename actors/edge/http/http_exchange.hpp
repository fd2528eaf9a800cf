#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"
#include "actors/house/limits.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace roscell {

/// One request to another node.
struct http_call {
  std::string address; ///< IPv4 address in dotted form.
  uint16_t port = 0;
  std::string method = "GET";
  std::string path; ///< Percent-encoded, begins with '/'.
  std::string body; ///< JSON; empty: none.
  /// From connecting to the last byte of the reply.
  std::chrono::milliseconds timeout = limits::cell::registration_call;
};

/// Asks once over a connection of its own, without a bearer token and without
/// waiting. Calls `callback` exactly once: on the io thread, but if that has
/// stopped before, then by the thread that let go of the call. A status other
/// than 200 is no error. Errors: `unreachable` if nobody answers, the
/// connection breaks, the reply is too long or none at all, or the io thread
/// stops; `timeout`; `schema_violation` for a call that cannot be made. From
/// any thread.
void exchange_http(io_thread& io, http_call what,
                   std::function<void(edge_result<http_reply>)> callback);

} // namespace roscell
