#pragma once

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/http/limits.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/trust/link_socket.hpp"

#include <boost/asio/steady_timer.hpp>

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// INTERNAL to this folder: a connection whose reply is a stream. It exists
/// before it gets the socket, so that its owner can write at once. `write`,
/// `close`, `break_off` and `on_closed` may be called from any thread.
class stream_connection
    : public std::enable_shared_from_this<stream_connection> {
public:
  stream_connection(std::shared_ptr<io_core> core, const http_limits& limits,
                    std::string content_type);

  /// The stream for its owner, which closes this when it is let go.
  static std::shared_ptr<http_stream>
  make_handle(std::shared_ptr<stream_connection> stream);

  /// Takes the socket and begins. `chunked` as HTTP/1.1 has it; `on_over` is
  /// called once when the socket is closed.
  void begin(link_socket socket, bool chunked, std::function<void()> on_over);

  bool write(std::string chunk);
  void close();
  void break_off();
  void on_closed(std::function<void()> callback);

  /// Ends it at once.
  void abort();

  /// Ends it after what was queued.
  void finish();

private:
  using error = boost::system::error_code;

  void enqueue(const std::string& chunk);
  void append(const std::string& chunk);
  void put(const std::string& framed);
  void cut();
  void flush();
  void on_written(error ec);
  void watch();
  void on_read(error ec, size_t size);
  void limit(std::chrono::milliseconds time);

  std::shared_ptr<io_core> core_;
  http_limits limits_;
  std::string content_type_;
  std::optional<link_socket> socket_;
  /// What was asked for before there was a socket.
  std::vector<std::string> early_;
  bool finish_early_ = false;
  boost::asio::steady_timer timer_;
  std::function<void()> on_over_;
  std::function<void()> on_closed_;
  std::string waiting_;   ///< Framed bytes that are not being written.
  std::string in_flight_; ///< Framed bytes that are.
  std::array<char, 512> ignored_{};
  size_t ignored_bytes_ = 0;
  std::atomic<size_t> queued_bytes_{0};
  std::atomic<bool> open_{true};
  bool chunked_ = false;
  bool writing_ = false;
  bool last_ = false; ///< Nothing is appended any more.
  bool cut_ = false;  ///< It gets no proper end.
  bool shut_down_ = false;
  bool over_ = false;
};

} // namespace roscell
