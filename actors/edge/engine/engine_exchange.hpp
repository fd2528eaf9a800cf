#pragma once

#include "actors/edge/engine/engine_client.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/stream_socket.hpp"
#include "actors/edge/io/unique_fd.hpp"

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <memory>
#include <string>
#include <string_view>

namespace roscell {

/// INTERNAL to this folder: one request to an engine and its answer. Io thread
/// only.
class engine_exchange final
    : public io_component,
      public std::enable_shared_from_this<engine_exchange> {
public:
  using error = boost::system::error_code;

  /// Without `on_bytes` the answer's body is kept, else it is passed on.
  engine_exchange(std::shared_ptr<io_core> core, std::string socket,
                  engine_request what, engine_stream_callbacks calls);

  void start();

  /// Ends without a further callback.
  void cancel();

  void on_io_stop() override;

private:
  void connect();
  void on_connected(error ec);
  void write_head();
  void write_file();
  void read();
  void on_read(error ec, size_t bytes);
  error parse(std::string_view bytes);
  bool pass_on();
  void finish(engine_answer answer);
  void fail(const std::string& why);
  void close();
  std::string head() const;

  std::shared_ptr<io_core> core_;
  std::string path_;
  engine_request what_;
  engine_stream_callbacks calls_;
  stream_socket socket_;
  boost::asio::steady_timer timer_;
  unique_fd file_;
  uint64_t file_bytes_ = 0;
  std::string outgoing_;
  std::string incoming_; ///< What is being read.
  std::string pending_;  ///< Read, but not parsed yet.
  boost::beast::http::response_parser<boost::beast::http::string_body> parser_;
  bool opened_ = false;
  bool over_ = false;
};

} // namespace roscell
