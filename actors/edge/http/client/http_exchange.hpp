#pragma once

#include "actors/edge/http/client/http_call.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/io/unique_fd.hpp"
#include "actors/edge/trust/link_socket.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace roscell {

/// INTERNAL to the edge: one call and its reply, from connecting to the end.
/// Io thread only, but it may be made and let go on any.
class http_exchange final : public io_component,
                            public std::enable_shared_from_this<http_exchange> {
public:
  using error = boost::system::error_code;

  /// Without `on_bytes` the reply's body is kept, else it is passed on.
  http_exchange(std::shared_ptr<io_core> core, http_call what,
                http_callbacks calls);

  /// The loop may end before it has begun with this: then it tells of it.
  ~http_exchange() override;

  void start();

  /// Ends without a further callback.
  void cancel();

  /// Ends with this outcome.
  void finish(http_outcome outcome);

  void on_io_stop() override;

private:
  using parser =
      boost::beast::http::response_parser<boost::beast::http::string_body>;

  void limit_time();
  void connect();
  void on_connected(error ec);
  void secure();
  void on_secured(const std::optional<distrusted>& why);
  void ask();
  bool open_file();
  std::string head() const;
  void expect_reply();
  void write_head();
  void write_file();
  void read();
  void on_read(error ec, size_t bytes);
  error parse(std::string_view bytes);
  void on_broken(error ec);
  bool pass_on();
  bool is_stream() const;
  void fail(http_failure::kind what, std::string reason = {});
  void close();

  std::shared_ptr<io_core> core_;
  http_call what_;
  http_callbacks calls_;
  link_socket socket_;
  boost::asio::steady_timer timer_;
  unique_fd file_;
  uint64_t file_bytes_ = 0;
  std::string outgoing_;
  std::string incoming_; ///< What is being read.
  std::string pending_;  ///< Read, but not parsed yet.
  std::optional<parser> parser_;
  bool opened_ = false;
  bool over_ = false;
};

/// INTERNAL to the edge: asks a server again and again whether it lives, each
/// time on a connection of its own, while somebody waits for it on another one.
/// A process that is stopped keeps its connections, and the kernel goes on to
/// accept new ones, so that only an answer is a proof. Io thread only.
class life_probe : public std::enable_shared_from_this<life_probe> {
public:
  /// @param question asked after each `pause` without a byte.
  /// @param on_silent called when it gets no answer; the last that is done.
  life_probe(std::shared_ptr<io_core> core, http_call question,
             std::chrono::milliseconds pause, std::function<void()> on_silent);

  /// Waits for the first pause; while one is waited for, begins it anew.
  void wait();

private:
  void ask();
  void on_answer(const http_outcome& outcome);

  const std::shared_ptr<io_core> core_;
  const http_call question_;
  const std::chrono::milliseconds pause_;
  const std::function<void()> on_silent_;
  boost::asio::steady_timer timer_;
  unsigned waits_ = 0;
};

} // namespace roscell
