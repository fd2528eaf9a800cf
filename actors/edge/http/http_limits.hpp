#pragma once

#include "actors/edge/http/limits.hpp"

#include <chrono>
#include <cstddef>

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
