#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/io/edge_error.hpp"
#include "actors/edge/io/io_thread.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

namespace roscell {

class site_identity;

/// Which server a client speaks to.
struct http_endpoint {
  std::string socket_path; ///< Unix socket; if empty, `address` counts.
  std::string address;     ///< IPv4 address; for `http_client` also a name.
  uint16_t port = 8420;
  std::string token; ///< Bearer token for TCP; may be empty.
  /// By TCP what is said is TLS, and who asks proves to be this; null: plain.
  std::shared_ptr<site_identity> identity{};
  std::string uuid{}; ///< Of the node that must answer then; empty: any.
  const char* protocol = nullptr; ///< Spoken then inside; null: HTTP/1.1.

  /// As people call it: "ADDR:PORT", or the socket's path.
  std::string name() const;
};

/// One request. As it is made it has the bounds of what nodes ask each other.
struct http_call {
  http_call();

  http_endpoint to;
  std::string from; ///< Local address to ask by TCP from; empty: any.
  std::string method = "GET";
  std::string target; ///< Path and query, percent-encoded, begins with '/'.
  std::map<std::string, std::string> headers;
  std::string body;           ///< JSON; empty: none.
  std::filesystem::path file; ///< A tar file to be sent in place of `body`.
  /// From connecting to the last byte of the reply.
  std::chrono::milliseconds timeout;
  /// The timeout counts up to the reply's header; the rest may take forever.
  bool endless = false;
  size_t max_header_bytes;
  /// Longest body of a reply that is no stream.
  size_t max_reply_bytes;
};

/// Why there is no reply.
struct http_failure {
  enum class kind {
    bad_call,      ///< It cannot be made; `reason` says why.
    no_connection, ///< `system_error` says why.
    no_file,       ///< `system_error` says why.
    distrusted,    ///< The server is not of the site; `reason` says why.
    timeout,
    silent,   ///< The server gave no proof of life meanwhile.
    cut_off,  ///< The connection ended before the reply did.
    broken,   ///< What came is no reply.
    too_long, ///< The reply is.
    stopped,  ///< The io thread has.
    cancelled,
  };

  kind what = kind::broken;
  std::string reason;
  int system_error = 0;
};

/// The reply, whatever its status; of a stream its body is empty.
using http_outcome = std::variant<http_reply, http_failure>;

/// What comes of a call. All are called by the io thread, but `on_end` by the
/// one that lets go of the call if the io thread has stopped before.
struct http_callbacks {
  /// The server has agreed (status 2xx); bytes will follow.
  std::function<void()> on_open;
  /// Returns whether to go on.
  std::function<bool(std::string_view)> on_bytes;
  /// Called once, at the end, unless the call was cancelled.
  std::function<void(http_outcome)> on_end;
};

class http_exchange;

/// A call whose reply has no end. It is cancelled when this is let go; a
/// callback that runs at that moment is not waited for.
class http_subscription {
public:
  /// Nothing.
  http_subscription() = default;

  http_subscription(std::shared_ptr<io_core> core,
                    std::shared_ptr<http_exchange> exchange);
  http_subscription(http_subscription&&) noexcept = default;
  http_subscription& operator=(http_subscription&& other) noexcept;
  ~http_subscription();

private:
  void cancel() noexcept;

  std::shared_ptr<io_core> core_;
  std::shared_ptr<http_exchange> exchange_;
};

/// Asks over a connection of its own without waiting. From any thread.
void call_http(const std::shared_ptr<io_core>& core, http_call what,
               std::function<void(http_outcome)> on_end);

/// The same for a reply that is passed on as it comes.
http_subscription subscribe_http(const std::shared_ptr<io_core>& core,
                                 http_call what, http_callbacks calls);

/// A failure in words. Codes: `unreachable`, `timeout`, `conflict` if it was
/// cancelled, `schema_violation` for a call that cannot be made.
edge_error describe_http_failure(const http_failure& why,
                                 const http_call& what);

/// The same for a whole outcome.
edge_result<http_reply> to_edge_result(http_outcome outcome,
                                       const http_call& what);

} // namespace roscell
