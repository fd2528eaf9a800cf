#pragma once

#include "roscell/coded_error.hpp"
#include "roscell/node_event.hpp"

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <string_view>

/// A program that asks a node from outside, over HTTP: needs no actor system.
namespace roscell {

/// Where a node listens for requests.
struct client_target {
  std::string socket;        ///< Path of its Unix socket; empty: TCP.
  std::string host;          ///< Name or address.
  std::uint16_t port = 8420; ///< For TCP.
  std::string token;         ///< Bearer token for TCP, from DATA_DIR/token.
  /// Who asks by TCP, at a site of identities: a file as `roscell site issue`
  /// and `roscell login` make it. No token counts then.
  std::string identity_file{};
};

/// A node could not be asked. `code` is "unreachable" (nobody listens, or the
/// node went away in the middle), "timeout", "unauthorized", "schema_violation"
/// (such a call cannot be made) or the code of the node's own refusal.
class client_error : public coded_error {
public:
  using coded_error::coded_error;
};

/// Ends a `follow` from another thread or a signal handler. Stays cancelled.
class client_cancel {
public:
  class impl;

  client_cancel();
  ~client_cancel();

  /// Safe in a signal handler.
  void cancel() const;

  const impl& parts() const noexcept {
    return *impl_;
  }

private:
  std::unique_ptr<impl> impl_;
};

/// One node. Every function waits, may be called from any thread, also from
/// several at once, and throws client_error.
class client {
public:
  /// Throws client_error where the identity cannot be read.
  explicit client(const client_target& to);
  ~client();
  client(client&&) noexcept;
  client& operator=(client&&) noexcept;

  /// The JSON document that answers a request document, within `limit`. That
  /// of a refusal has the type "error", and is no exception.
  std::string request(const std::string& json,
                      std::chrono::milliseconds limit) const;

  /// The JSON document at a path of docs/operations.md, such as "/v1/nodes",
  /// within 10 s. A refusal is an exception.
  std::string get(const std::string& path) const;

  /// Gives the events after number `since`, then each new one, to `on_event`,
  /// in this thread, until that returns false, or `cancel` is used.
  void follow_events(std::uint64_t since,
                     const std::function<bool(const node_event&)>& on_event,
                     const client_cancel* cancel = nullptr) const;

  /// Gives the lines of an instance's log, as they come, until the instance
  /// has ended and all are told.
  void follow_log(const std::string& instance,
                  const std::function<bool(std::string_view line)>& on_line,
                  const client_cancel* cancel = nullptr) const;

private:
  class impl;
  std::unique_ptr<impl> impl_;
};

} // namespace roscell
