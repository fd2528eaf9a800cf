#pragma once

#include "actors/edge/limit_units.hpp"

#include <chrono>
#include <cstddef>

/// What one HTTP server, and one client, put up with.
namespace roscell::limits {

namespace cell {

/// What an HTTP client gives another node to answer a registration switch.
constexpr milliseconds registration_call{5000};

} // namespace cell

namespace http {

/// Request line and header fields together; more is answered with 431.
constexpr size_t header_bytes = 8 * kib;
/// A request's body; more is answered with 413 before it is read.
/// `document_limits` (schemas/document.hpp) takes JSON of this size.
constexpr size_t body_bytes = mib;
/// The same for the manifest of a build (limits::build).
constexpr size_t manifest_bytes = 4 * mib;
/// The same for unauthenticated peers, on the few paths that are open to them:
/// more than the longest registration switch.
constexpr size_t public_body_bytes = 8 * kib;
/// From connecting to the first byte.
constexpr milliseconds first_byte{10'000};
/// From a request's first byte to its last.
constexpr milliseconds whole_request{10'000};
/// Between two requests of one connection.
constexpr milliseconds idle{30'000};
/// For writing one reply to a slow reader.
constexpr milliseconds write{30'000};
/// For requests in progress when the server stops, and for a client to read
/// the error that ended its connection.
constexpr milliseconds grace{1000};
/// Of a client whose request was refused: what it still sends is read, so
/// that it gets to read the reply, but not without end.
constexpr size_t lingered_bytes = mib;
/// TCP connections that have not shown the bearer token yet. When one more
/// comes, the one that was silent for longest is closed: a crowd of silent
/// connections keeps nobody out who speaks at once.
constexpr size_t unauthenticated_peers = 64;
/// TCP connections that shake hands for a session, with the same rule: those of
/// a whole cell may come at one moment.
constexpr size_t joining = 256;
/// TCP connections that have shown it; one more is answered with 503.
constexpr size_t trusted = 192;
/// Connections to the Unix socket that are served at a time, those that wait
/// for their turn, and how long one waits before it is answered with 503, as
/// one more is at once.
constexpr size_t local = 64;
constexpr size_t waiting = 448;
constexpr seconds turn{60};
/// Clients that are being told that there is no room: each reads its 503 within
/// `grace`. One more is closed without a word.
constexpr size_t refused = 128;
/// Sessions; a request for one more is answered with 503.
constexpr size_t sessions = 1024;
/// Bytes that wait for one slow reader of a stream; beyond it, it is cut.
constexpr size_t stream_bytes = mib;
/// A client of a stream has nothing to say; a little is tolerated.
constexpr size_t stream_ignored_bytes = 64 * kib;
/// Replies that a client takes: of a node that it was pointed to, of another
/// node while it forms a cell, and one line of a stream.
constexpr size_t client_reply_bytes = 64 * mib;
constexpr size_t exchanged_bytes = 64 * kib;
constexpr size_t client_line_bytes = mib;
/// What a client waits where nothing else is said.
constexpr seconds client_timeout{30};
/// Ports that the system hands out for UDP are rarely taken for TCP.
constexpr int port_attempts = 16;
/// After the process ran out of descriptors.
constexpr milliseconds shortage_pause{100};

} // namespace http

} // namespace roscell::limits

namespace roscell {

/// What one HTTP server puts up with, see `limits::http`. Tests shorten it.
struct http_limits {
  size_t header_bytes = limits::http::header_bytes;
  size_t body_bytes = limits::http::body_bytes;
  size_t public_body_bytes = limits::http::public_body_bytes;
  std::chrono::milliseconds first_byte = limits::http::first_byte;
  std::chrono::milliseconds whole_request = limits::http::whole_request;
  std::chrono::milliseconds idle = limits::http::idle;
  std::chrono::milliseconds write = limits::http::write;
  std::chrono::milliseconds grace = limits::http::grace;
  size_t unauthenticated_peers = limits::http::unauthenticated_peers;
  size_t joining = limits::http::joining;
  size_t trusted = limits::http::trusted;
  size_t local = limits::http::local;
  size_t waiting = limits::http::waiting;
  size_t refused = limits::http::refused;
  std::chrono::milliseconds turn = limits::http::turn;
  size_t sessions = limits::http::sessions;
  size_t stream_bytes = limits::http::stream_bytes;
};

} // namespace roscell
