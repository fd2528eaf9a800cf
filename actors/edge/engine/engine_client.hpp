#pragma once

#include "actors/edge/engine/limits.hpp"
#include "actors/edge/http/client/http_call.hpp"

#include <chrono>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace roscell {

/// What Podman's own API begins with, at its version. All that Docker's API
/// has, too, Podman is asked without a version.
inline constexpr const char* podman_api = "/v4.0.0/libpod";

/// One request to a container engine.
struct engine_request {
  std::string method = "GET";
  std::string target; ///< Path and query, percent-encoded.
  std::map<std::string, std::string> headers; ///< Besides the usual ones.
  std::string body;                           ///< JSON; empty: none.
  std::filesystem::path file; ///< A tar file to be sent in place of `body`.
  /// From connecting to the last byte of the answer.
  std::chrono::milliseconds limit = limits::engine::call;
  /// The limit counts up to the answer's first byte; the rest may take forever.
  bool endless = false;
};

struct engine_reply {
  int status = 0;
  std::string body; ///< Of a stream that was opened: empty.

  bool ok() const {
    return status >= 200 && status < 300;
  }
};

/// The engine's reply, good or bad, or why there is none: `unreachable`,
/// `unauthorized` (no permission on the socket) or `timeout`. A broken stream
/// is `unreachable`.
using engine_answer = edge_result<engine_reply>;

/// What comes of a streamed answer, as calls on the io thread.
struct engine_stream_callbacks {
  /// The engine has agreed; bytes will follow.
  std::function<void()> on_open;
  /// Returns whether to go on.
  std::function<bool(std::string_view)> on_bytes;
  /// Called once, at the end, unless the stream was cancelled.
  std::function<void(engine_answer)> on_end;
};

/// A streamed answer, which is cancelled when this is let go.
using engine_stream = http_subscription;

/// Speaks HTTP with a container engine (Docker, Podman) on its Unix socket,
/// without waiting. Each request has a connection of its own. May be called
/// from any thread.
class engine_client {
public:
  /// @param api the version of Docker's API that is spoken, "1.41"; empty:
  ///   whatever the engine itself takes.
  engine_client(std::shared_ptr<io_core> core, std::string socket,
                std::string api = {});

  /// Calls `on_answer` once, on the io thread.
  void request(engine_request what,
               std::function<void(engine_answer)> on_answer) const;

  engine_stream stream(engine_request what,
                       engine_stream_callbacks calls) const;

  const std::string& socket() const {
    return socket_;
  }

private:
  std::shared_ptr<io_core> core_;
  std::string socket_;
  std::string prefix_; ///< Of all paths.
};

/// What a reply that is not good says, in the engine's own words: Docker's
/// `message`, Podman's `message` and `cause`. Code: engine_failed.
edge_error engine_refusal(const std::string& what, const engine_reply& reply);

/// Why a socket cannot be connected to, with the remedy.
edge_error no_engine(const std::string& socket, int error_number);

/// How a person sees what the engine behind a socket has logged.
std::string engine_log_command(const std::string& socket);

} // namespace roscell
