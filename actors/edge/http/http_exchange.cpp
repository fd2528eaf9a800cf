#include "actors/edge/http/http_exchange.hpp"

#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/stream_socket.hpp"
#include "actors/house/limits.hpp"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>

#include <memory>
#include <utility>

namespace roscell {

namespace {

namespace http = boost::beast::http;
namespace ip = boost::asio::ip;

std::string name_of(const http_call& what) {
  return what.address + ":" + std::to_string(what.port);
}

/// Whether the text can stand in a request line as it is.
bool is_path(const std::string& text) {
  return text.find(' ') == std::string::npos && parse_target(text).has_value();
}

http::request<http::string_body> to_request(const http_call& what) {
  http::request<http::string_body> result;
  result.method_string(what.method);
  result.target(what.path);
  result.set(http::field::host, name_of(what));
  result.set(http::field::user_agent, "roscell");
  result.keep_alive(false);
  if (!what.body.empty())
    result.set(http::field::content_type, json_content);
  result.body() = what.body;
  result.prepare_payload();
  return result;
}

http_reply to_reply(http::response<http::string_body> message) {
  const auto type = message[http::field::content_type];
  return {static_cast<int>(message.result_int()),
          {type.data(), type.size()},
          std::move(message.body())};
}

/// One call, from connecting to its end. Io thread only.
class http_exchange : public io_component,
                      public std::enable_shared_from_this<http_exchange> {
public:
  using error = boost::system::error_code;
  using answer = edge_result<http_reply>;

  http_exchange(std::shared_ptr<io_core> core, http_call what,
                std::function<void(answer)> callback)
      : core_(std::move(core)), what_(std::move(what)),
        callback_(std::move(callback)), socket_(core_->context()),
        timer_(core_->context()) {
    parser_.body_limit(limits::http::exchanged_bytes);
  }

  /// The io thread may end before it has begun with this.
  ~http_exchange() override {
    report(stopped());
  }

  void run() {
    core_->adopt(shared_from_this());
    error ec;
    const auto address = ip::make_address_v4(what_.address, ec);
    if (ec || what_.port == 0)
      return fail(error_code::schema_violation,
                  "'" + name_of(what_) + "' is no IPv4 address and port");
    if (!is_path(what_.path))
      return fail(error_code::schema_violation,
                  "'" + what_.path + "' is no path of an HTTP request");
    timer_.expires_after(what_.timeout);
    timer_.async_wait([self = shared_from_this()](error timer_ec) {
      if (!timer_ec)
        self->fail(error_code::timeout,
                   name_of(self->what_) + " did not answer within "
                       + std::to_string(self->what_.timeout.count()) + " ms");
    });
    open_tcp(socket_);
    socket_.async_connect(ip::tcp::endpoint{address, what_.port},
                          [self = shared_from_this()](error connect_ec) {
                            if (!self->over_)
                              self->on_connected(connect_ec);
                          });
  }

  void on_io_stop() override {
    finish(stopped());
  }

private:
  void on_connected(error ec) {
    if (ec)
      return fail(error_code::unreachable,
                  "cannot connect to " + name_of(what_) + ": " + ec.message());
    request_ = to_request(what_);
    http::async_write(socket_, request_,
                      [self = shared_from_this()](error, size_t) {
                        // What went wrong is seen by reading.
                      });
    // The peer may refuse before it has read everything.
    http::async_read(socket_, incoming_, parser_,
                     [self = shared_from_this()](error read_ec, size_t) {
                       if (!self->over_)
                         self->on_reply(read_ec);
                     });
  }

  void on_reply(error ec) {
    if (!ec)
      return finish(to_reply(parser_.release()));
    if (ec == http::error::body_limit)
      return fail(error_code::unreachable,
                  "the reply of " + name_of(what_) + " is longer than "
                      + std::to_string(limits::http::exchanged_bytes)
                      + " bytes");
    fail(error_code::unreachable,
         name_of(what_) + " gave no reply that can be read: " + ec.message());
  }

  void fail(error_code code, std::string message) {
    finish(edge_error{code, std::move(message), ""});
  }

  void finish(answer result) {
    if (std::exchange(over_, true))
      return;
    const auto self = shared_from_this();
    timer_.cancel();
    close_now(socket_);
    core_->release(this);
    report(std::move(result));
  }

  void report(answer result) {
    const auto callback = std::exchange(callback_, nullptr);
    if (callback)
      core_->guarded([&] { callback(std::move(result)); });
  }

  edge_error stopped() const {
    return {error_code::unreachable,
            "the io thread stopped before " + name_of(what_) + " answered", ""};
  }

  std::shared_ptr<io_core> core_;
  http_call what_;
  std::function<void(answer)> callback_;
  stream_socket socket_;
  boost::asio::steady_timer timer_;
  http::request<http::string_body> request_;
  boost::beast::flat_buffer incoming_;
  http::response_parser<http::string_body> parser_;
  bool over_ = false;
};

} // namespace

void exchange_http(io_thread& io, http_call what,
                   std::function<void(edge_result<http_reply>)> callback) {
  auto exchange = std::make_shared<http_exchange>(io.core(), std::move(what),
                                                  std::move(callback));
  io.core()->post([exchange = std::move(exchange)] { exchange->run(); });
}

} // namespace roscell
