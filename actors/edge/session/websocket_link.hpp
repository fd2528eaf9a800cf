#pragma once

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/edge/session/session_socket.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/websocket/stream.hpp>

#include <atomic>
#include <deque>
#include <memory>
#include <optional>
#include <string>

namespace roscell {

/// INTERNAL to this folder: WebSocket without compression, over TCP.
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
