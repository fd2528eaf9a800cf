#include "actors/edge/http/http_client.hpp"

#include "actors/edge/http/client_socket.hpp"
#include "actors/edge/io/line_splitter.hpp"
#include "actors/house/limits.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/string_body.hpp>

#include <algorithm>
#include <array>
#include <cerrno>
#include <limits>
#include <optional>
#include <system_error>
#include <utility>

#include <sys/eventfd.h>
#include <unistd.h>

namespace roscell {

namespace {

namespace http = boost::beast::http;

using parser = http::response_parser<http::string_body>;

constexpr size_t read_bytes = 16 * 1024;

bool is_clean(std::string_view text) {
  return std::none_of(text.begin(), text.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return byte < 0x20 || byte == 0x7f;
  });
}

std::string render(const http_endpoint& to, const std::string& method,
                   const std::string& path, const std::string& body,
                   const http_client::options& how) {
  const auto host = to.socket_path.empty() ? to.address : "localhost";
  auto text = method + " " + path + " HTTP/1.1\r\nHost: " + host
              + "\r\nConnection: close\r\n";
  if (!to.token.empty() && to.socket_path.empty())
    text += "Authorization: Bearer " + to.token + "\r\n";
  for (const auto& [name, value] : how.headers)
    text += name + ": " + value + "\r\n";
  if (method != "GET" || !body.empty())
    text += "Content-Type: application/json\r\nContent-Length: "
            + std::to_string(body.size()) + "\r\n";
  return text + "\r\n" + body;
}

/// One request and its reply.
class exchange {
public:
  exchange(const http_endpoint& to, const http_client::options& how)
      : to_(to), how_(how),
        socket_(client_socket::clock::now() + how.timeout, how.cancel) {
    expect_reply();
  }

  std::optional<edge_error> send(const std::string& method,
                                 const std::string& path,
                                 const std::string& body) {
    if (!is_clean(path) || path.find(' ') != std::string::npos
        || !is_clean(to_.token))
      return edge_error{error_code::schema_violation,
                        "the path or the token has a space or a control "
                        "character in it",
                        ""};
    if (auto failure = socket_.connect(to_))
      return failure;
    return socket_.send(render(to_, method, path, body, how_));
  }

  /// Reads and parses once more.
  std::optional<edge_error> step() {
    std::array<char, read_bytes> buffer;
    auto got = socket_.receive(buffer.data(), buffer.size());
    if (auto* failure = std::get_if<edge_error>(&got))
      return std::move(*failure);
    const auto bytes = std::get<std::string_view>(got);
    boost::system::error_code ec;
    if (bytes.empty() && parser_->got_some())
      parser_->put_eof(ec);
    else if (!bytes.empty())
      parse(bytes, ec);
    if (!ec && (!bytes.empty() || parser_->is_done()))
      return std::nullopt;
    return edge_error{
        error_code::unreachable,
        "the reply is broken: " + (ec ? ec.message() : "it has no end"), ""};
  }

  parser& reply() {
    return *parser_;
  }

  client_socket& socket() {
    return socket_;
  }

  http_reply take_reply() {
    auto& message = parser_->get();
    const auto type = message[http::field::content_type];
    return {static_cast<int>(message.result_int()),
            {type.data(), type.size()},
            std::move(message.body())};
  }

private:
  void expect_reply() {
    parser_.emplace();
    parser_->body_limit(limits::http::client_reply_bytes);
    parser_->eager(true);
  }

  void parse(std::string_view bytes, boost::system::error_code& ec) {
    pending_ += bytes;
    while (!pending_.empty() && !parser_->is_done()) {
      const auto used = parser_->put(
          boost::asio::buffer(pending_.data(), pending_.size()), ec);
      pending_.erase(0, used);
      if (ec)
        break;
      // "100 Continue" comes before the reply.
      if (parser_->is_done() && parser_->get().result_int() < 200)
        expect_reply();
    }
    if (ec == http::error::need_more)
      ec = {};
  }

  const http_endpoint& to_;
  const http_client::options& how_;
  client_socket socket_;
  std::optional<parser> parser_;
  std::string pending_; ///< Read but not parsed yet.
};

} // namespace

http_cancel::http_cancel() : fd_(::eventfd(0, EFD_CLOEXEC | EFD_NONBLOCK)) {
  if (fd_ < 0)
    throw std::system_error(errno, std::generic_category(), "eventfd");
}

http_cancel::~http_cancel() {
  ::close(fd_);
}

void http_cancel::cancel() const {
  const uint64_t one = 1;
  [[maybe_unused]] const auto written = ::write(fd_, &one, sizeof one);
}

http_client::http_client(http_endpoint to) : to_(std::move(to)) {
  // nop
}

edge_result<http_reply> http_client::request(const std::string& method,
                                             const std::string& path,
                                             const std::string& body,
                                             const options& how) const {
  exchange turn{to_, how};
  if (auto failure = turn.send(method, path, body))
    return *failure;
  while (!turn.reply().is_done())
    if (auto failure = turn.step())
      return *failure;
  return turn.take_reply();
}

edge_result<http_reply>
http_client::follow(const std::string& path,
                    const std::function<bool(std::string_view line)>& on_line,
                    const options& how) const {
  exchange turn{to_, how};
  if (auto failure = turn.send("GET", path, {}))
    return *failure;
  line_splitter lines{limits::http::client_line_bytes, on_line};
  auto& reply = turn.reply();
  bool streaming = false;
  while (!reply.is_done()) {
    if (auto failure = turn.step())
      return *failure;
    if (reply.is_header_done() && reply.get().result_int() == 200
        && !std::exchange(streaming, true)) {
      turn.socket().wait_forever();
      reply.body_limit(std::numeric_limits<uint64_t>::max());
    }
    if (!streaming)
      continue;
    if (!lines.take(std::exchange(reply.get().body(), {})))
      break;
    if (lines.too_long())
      return edge_error{error_code::unreachable, "a line has no end", ""};
  }
  if (streaming && reply.is_done())
    lines.finish();
  return turn.take_reply();
}

} // namespace roscell
