#pragma once

#include "messages/failure.hpp"

#include <atomic>
#include <chrono>
#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>

namespace roscell {

struct http_request {
  std::string method; ///< GET or POST.
  std::string path;   ///< Percent-decoded, begins with '/'.
  std::map<std::string, std::string> query; ///< Percent-decoded.
  std::string body;
  std::string accept; ///< What kinds of reply the client takes.
  bool local = false; ///< It came by the Unix socket.
  std::string from;   ///< Who asks, for people: "root", "10.0.0.3:40112".
  std::string role; ///< At the site, as his identity says; empty: he has none.
  /// What he shows lets him read this path whatever his role is.
  bool permitted = false;
  /// Of one who comes for an identity: keying material of his connection, in
  /// hexadecimal, and what he has shown, if anything.
  std::string exported;
  std::string peer; ///< A certificate, as PEM.
};

/// The role of one who comes for an identity, with none or one that has ended.
inline constexpr const char* newcomer_role = "newcomer";

struct http_reply {
  int status = 200;
  std::string content_type;
  std::string body;
};

inline constexpr const char* json_content = "application/json";
inline constexpr const char* event_stream_content = "text/event-stream";

/// A reply without an end: server-sent events, or a log that is followed.
/// All methods may be called from any thread, also after the end. Letting go
/// of the stream closes it.
class http_stream {
public:
  virtual ~http_stream() = default;

  /// Queues some bytes. False if the stream is over. A reader that lets more
  /// wait than `http_limits::stream_bytes` is cut off, in an event stream
  /// with an `error` event as the last thing it gets.
  virtual bool write(std::string chunk) = 0;

  /// Calls `callback` once when the stream is over for whatever reason, on
  /// the io thread. On this thread at once if the request was answered before
  /// the stream was made.
  virtual void on_closed(std::function<void()> callback) = 0;

  /// Ends the stream after what was queued.
  virtual void close() = 0;

  /// The same where more should have come: the reader sees that it has no
  /// proper end.
  virtual void break_off() = 0;
};

/// Where a reply goes. Implemented by the server, and by fakes in tests.
class reply_sink {
public:
  virtual ~reply_sink() = default;
  virtual void reply(http_reply reply) = 0;
  virtual std::shared_ptr<http_stream> stream(std::string content_type) = 0;
};

/// Answers one request, once: the first answer counts and later ones are
/// ignored. Copies answer the same request. May be called from any thread,
/// also after the client has gone. If all copies are dropped without an
/// answer the client gets status 500.
class responder {
public:
  explicit responder(std::shared_ptr<reply_sink> sink);

  void reply(int status, std::string content_type, std::string body) const;

  /// Answers with the JSON form of an error.
  void error(int status, error_code code, std::string_view message,
             std::string_view hint = {}) const;

  /// Answers with status 200 and a body that follows. A stream that is over
  /// already if the request was answered before.
  std::shared_ptr<http_stream> stream(std::string content_type) const;

private:
  struct once;
  std::shared_ptr<once> once_;
};

/// Called on the io thread; must return soon.
using http_handler = std::function<void(http_request, responder)>;

/// The text of `{"type":"error","error":{"code","message","where","hint"}}`.
/// Bytes that are no UTF-8 are replaced.
std::string error_body(error_code code, std::string_view message,
                       std::string_view hint = {}, std::string_view where = {});

} // namespace roscell
