#pragma once

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/session/limits.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/edge/trust/link_socket.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <boost/beast/websocket/teardown.hpp>

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

/// INTERNAL to this folder. Beast ends a WebSocket by waiting for its peer to
/// close, without a time limit; this socket does not let it wait for long.
namespace roscell {

class session_socket : public link_socket {
public:
  explicit session_socket(link_socket&& socket)
      : link_socket(std::move(socket)) {
    // nop
  }

  /// How long a peer may take to read the last frame and close.
  std::chrono::milliseconds linger_time = limits::session::linger;
};

/// Says that nothing more will be sent, and reads what still comes until the
/// peer closes or the time is over: closing with unread bytes would destroy
/// the last frame on its way. Calls `done` then, never at once.
void linger(session_socket& socket,
            std::function<void(boost::system::error_code)> done);

/// Beast finds these two by the type of the socket.
template <class Handler>
void async_teardown(boost::beast::role_type, session_socket& socket,
                    Handler&& handler) {
  auto shared =
      std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
  linger(socket, [shared](boost::system::error_code ec) { (*shared)(ec); });
}

inline void teardown(boost::beast::role_type, session_socket& socket,
                     boost::system::error_code& ec) {
  socket.close();
  ec = {};
}

/// INTERNAL to this folder: WebSocket without compression, over TCP or TLS.
using websocket = boost::beast::websocket::stream<session_socket, false>;

/// The machinery of a session_link. Everything but `send`, `close` and
/// `queued_bytes` runs on the io thread.
class websocket_link : public io_component,
                       public std::enable_shared_from_this<websocket_link> {
public:
  using error = boost::system::error_code;

  /// `on_gone` is called once when the session has ended, for the tables of
  /// the server that it came from.
  websocket_link(std::shared_ptr<io_core> core, websocket&& stream,
                 session_options options, std::function<void()> on_gone);

  /// The link for its owner, which closes this when it is let go.
  static std::shared_ptr<session_link> make(std::shared_ptr<io_core> core,
                                            websocket&& stream,
                                            session_options options,
                                            std::function<void()> on_gone);

  void start(session_callbacks callbacks);
  bool send(std::string text);
  void close(std::string reason);
  size_t queued_bytes() const {
    return queued_bytes_;
  }

  void on_io_stop() override;

  /// A frame that was given out is done: there is room for another one.
  void on_frame_done();

private:
  using frame_action = void (websocket_link::*)(std::string);

  void filter(traffic_direction direction, std::string text,
              frame_action action);
  void act_later(std::chrono::milliseconds delay, std::string text,
                 frame_action action);

  void enqueue(std::string text);
  void write_next();
  void on_written(error ec);

  void read_next();
  void on_read(error ec);
  void deliver(std::string text);
  session_end end_of(error ec) const;

  void close_soon(session_end end);
  void send_close_frame();
  void finish_later(session_end end);
  void finish(session_end end);
  void report_end();

  std::shared_ptr<io_core> core_;
  websocket stream_;
  session_options options_;
  std::function<void()> on_gone_;
  session_callbacks callbacks_;
  boost::asio::steady_timer close_timer_;
  boost::beast::flat_buffer incoming_;
  std::deque<std::string> outgoing_;
  std::atomic<size_t> queued_bytes_{0};
  std::atomic<bool> open_{true}; ///< Whether `send` still takes frames.
  size_t undone_ = 0;
  bool started_ = false;
  bool reading_ = false;
  bool writing_ = false;
  bool close_frame_sent_ = false;
  std::optional<session_end> closing_; ///< Set once `close_soon` was called.
  std::optional<session_end> ended_;   ///< Set once it is all over.
};

} // namespace roscell
