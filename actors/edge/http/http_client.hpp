#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/io/edge_error.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>

namespace roscell {

/// Which node a client speaks to.
struct http_endpoint {
  std::string socket_path; ///< Unix socket; if empty, `address` counts.
  std::string address;     ///< IPv4 address or host name.
  uint16_t port = 8420;
  std::string token; ///< Bearer token for TCP; may be empty.
};

/// Stops an http_client that waits, from another thread or a signal handler.
/// Stays cancelled.
class http_cancel {
public:
  http_cancel();
  ~http_cancel();

  http_cancel(const http_cancel&) = delete;
  http_cancel& operator=(const http_cancel&) = delete;

  /// Safe in a signal handler.
  void cancel() const;

  /// Readable once `cancel` was called.
  int fd() const {
    return fd_;
  }

private:
  int fd_;
};

/// A small client for the command line, which waits. Each request uses a
/// connection of its own. Objects may be shared between threads.
class http_client {
public:
  explicit http_client(http_endpoint to);

  struct options {
    std::map<std::string, std::string> headers;
    /// For `request` from the first connection attempt to the last byte, for
    /// `follow` up to the beginning of the reply.
    std::chrono::milliseconds timeout{30'000};
    const http_cancel* cancel = nullptr;
  };

  /// Errors: `unreachable` if nobody answers or the connection breaks,
  /// `timeout`, `conflict` if it was cancelled, `schema_violation` for a path
  /// that cannot be asked for. A status other than 200 is no error here.
  edge_result<http_reply> request(const std::string& method,
                                  const std::string& path,
                                  const std::string& body,
                                  const options& how) const;

  /// Asks by GET for a reply without an end, and calls `on_line` for each of
  /// its lines without the line feed, until it returns false, the reply
  /// ends, or the wait is cancelled. The body of the result is empty, but if
  /// the status is not 200 it is the whole reply. Errors: as above; a stream
  /// that breaks without a proper end is `unreachable`.
  edge_result<http_reply>
  follow(const std::string& path,
         const std::function<bool(std::string_view line)>& on_line,
         const options& how) const;

private:
  http_endpoint to_;
};

} // namespace roscell
