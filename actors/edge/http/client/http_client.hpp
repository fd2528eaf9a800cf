#pragma once

#include "actors/edge/http/client/http_call.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

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

/// A small client for the command line, which waits: each request runs an
/// event loop and a connection of its own. Objects may be shared between
/// threads.
class http_client {
public:
  explicit http_client(http_endpoint to);

  const http_endpoint& endpoint() const {
    return to_;
  }

  /// How a server that sends nothing is asked whether it lives.
  struct proof_of_life {
    std::string path; ///< Asked by GET on a connection of its own.
    /// Without a byte, before it is asked, and asked again.
    std::chrono::milliseconds pause;
    std::chrono::milliseconds limit; ///< For the answer.
  };

  struct options {
    options();

    std::map<std::string, std::string> headers;
    /// For `request` from the first connection attempt to the last byte, for
    /// `follow` up to the beginning of the reply.
    std::chrono::milliseconds timeout;
    const http_cancel* cancel = nullptr;
    /// Ends the wait for a server that does not live, with `unreachable`;
    /// without it only the timeout does.
    std::optional<proof_of_life> proof;
    /// The error where the server ends the connection before it has answered;
    /// otherwise a general one.
    std::optional<edge_error> when_cut_off;
  };

  /// Errors: as `describe_http_failure` says. A status other than 200 is no
  /// error here.
  edge_result<http_reply> request(const std::string& method,
                                  const std::string& path,
                                  const std::string& body,
                                  const options& how) const;

  /// Asks by GET for a reply without an end, and calls `on_line` for each of
  /// its lines without the line feed, until it returns false, the reply
  /// ends, or the wait is cancelled. The body of the result is empty, but if
  /// the server refused it is the whole reply. Errors: as above; a stream
  /// that breaks without a proper end is `unreachable`.
  edge_result<http_reply>
  follow(const std::string& path,
         const std::function<bool(std::string_view line)>& on_line,
         const options& how) const;

  /// Asks by GET for a reply that is passed on as it comes, until `on_bytes`
  /// returns false; `timeout` holds for all of it. The body of the result is
  /// empty, but if the server refused it is the whole reply. Errors: as above.
  edge_result<http_reply>
  download(const std::string& path,
           const std::function<bool(std::string_view)>& on_bytes,
           const options& how) const;

  /// Sends a tar file by POST. Errors: as above; one that cannot be read.
  edge_result<http_reply> send_file(const std::string& path,
                                    const std::filesystem::path& file,
                                    const options& how) const;

private:
  http_call call_to(const std::string& path, const options& how) const;
  edge_result<http_reply> run(const http_call& what, const options& how,
                              http_callbacks calls) const;

  http_endpoint to_;
};

} // namespace roscell
