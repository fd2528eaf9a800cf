#include "actors/edge/http/http_connection.hpp"

#include "actors/edge/http/http_shared.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/http/http_types.hpp"
#include "actors/edge/http/limits.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/rfc7230.hpp>

#include <array>
#include <limits>
#include <utility>
#include <variant>

namespace roscell {

namespace {

namespace http = boost::beast::http;

constexpr size_t read_bytes = 8 * 1024;

/// Static: the connection's own buffer is for replies.
constexpr std::string_view go_on = "HTTP/1.1 100 Continue\r\n\r\n";

std::string_view to_view(boost::beast::string_view text) {
  return {text.data(), text.size()};
}

} // namespace

http_connection::http_connection(std::shared_ptr<http_shared> shared,
                                 link_socket socket, bool local)
    : shared_(std::move(shared)), socket_(std::move(socket)), local_(local),
      timer_(shared_->core->context()) {
  // nop
}

void http_connection::run() {
  // One that waited too long for its turn is being told so.
  if (phase_ != phase::queued)
    return;
  if (shared_->identity && !local_)
    prove();
  else
    begin_requests();
}

void http_connection::begin_requests() {
  next_request();
  limit(shared_->limits.first_byte);
  read();
}

void http_connection::wait_for_turn() {
  limit(shared_->limits.turn);
}

void http_connection::next_request() {
  phase_ = phase::waiting;
  header_done_ = false;
  parser_.emplace();
  parser_->header_limit(static_cast<uint32_t>(shared_->limits.header_bytes));
  // The length that a header announces is checked together with the header.
  parser_->body_limit(std::numeric_limits<uint64_t>::max());
}

void http_connection::limit(std::chrono::milliseconds time) {
  timer_.expires_after(time);
  timer_.async_wait([self = shared_from_this()](error ec) {
    // A timer that was set anew while its handler was queued is not due.
    if (!ec && self->timer_.expiry() <= clock::now())
      self->on_time_limit();
  });
}

void http_connection::on_time_limit() {
  // A timer that was cancelled may still have had its handler queued.
  if (phase_ == phase::answering || phase_ == phase::handed_over)
    return;
  if (phase_ == phase::queued)
    return refuse_crowd();
  if (phase_ == phase::proving) {
    on_proved(distrusted{
        distrust::no_certificate, "its handshake took too long", {}});
    return abort();
  }
  if (phase_ != phase::reading)
    return abort();
  refuse_request(408, error_code::timeout,
                 "the request took too long to arrive");
}

void http_connection::read() {
  socket_.async_read_some(incoming_.prepare(read_bytes),
                          [self = shared_from_this()](error ec, size_t size) {
                            self->on_read(ec, size);
                          });
}

void http_connection::on_read(error ec, size_t size) {
  if (phase_ == phase::closed)
    return;
  if (ec)
    return abort();
  last_heard_ = clock::now();
  if (phase_ == phase::lingering) {
    lingered_bytes_ += size;
    return lingered_bytes_ > limits::http::lingered_bytes ? abort() : read();
  }
  if (phase_ != phase::waiting && phase_ != phase::reading)
    return;
  incoming_.commit(size);
  parse();
}

void http_connection::parse() {
  if (std::exchange(phase_, phase::reading) == phase::waiting)
    limit(shared_->limits.whole_request);
  while (!parser_->is_done() && incoming_.size() > 0)
    if (!parse_some())
      return;
  if (parser_->is_done())
    dispatch();
  else
    read();
}

/// Feeds the parser. False if the next step is not this function's to take.
bool http_connection::parse_some() {
  error ec;
  incoming_.consume(parser_->put(incoming_.data(), ec));
  if (ec && ec != http::error::need_more) {
    on_bad_request(ec);
    return false;
  }
  if (parser_->is_header_done() && !std::exchange(header_done_, true)
      && !on_header())
    return false;
  if (ec == http::error::need_more && !parser_->is_done()) {
    read();
    return false;
  }
  return true;
}

void http_connection::on_bad_request(error ec) {
  if (ec == http::error::header_limit)
    refuse_request(431, error_code::schema_violation,
                   "the header of the request is larger than "
                       + std::to_string(shared_->limits.header_bytes)
                       + " bytes");
  else if (ec == http::error::body_limit)
    refuse_request(413, error_code::malformed_json,
                   "the body of the request is larger than "
                       + std::to_string(body_limit_) + " bytes");
  else
    refuse_request(400, error_code::schema_violation,
                   "this is no HTTP request: " + ec.message());
}

bool http_connection::check_body(size_t most_bytes) {
  body_limit_ = most_bytes;
  const auto announced = parser_->content_length();
  if (announced && *announced > most_bytes) {
    on_bad_request(http::error::body_limit);
    return false;
  }
  // For a body in chunks, whose length nobody knows.
  parser_->body_limit(most_bytes);
  parser_->eager(true);
  const auto expect = parser_->get()[http::field::expect];
  if (parser_->is_done() || !boost::beast::iequals(expect, "100-continue"))
    return true;
  // Nothing else may be written meanwhile: who does not read it in time is
  // closed without a word.
  phase_ = phase::continuing;
  boost::asio::async_write(socket_, boost::asio::buffer(go_on),
                           [self = shared_from_this()](error ec, size_t) {
                             if (self->phase_ != phase::continuing)
                               return;
                             if (ec)
                               self->abort();
                             else
                               self->parse();
                           });
  return false;
}

void http_connection::dispatch() {
  phase_ = phase::answering;
  timer_.cancel();
  auto& message = parser_->get();
  auto target = parse_target(to_view(message.target()));
  http_request request;
  request.method = std::string{to_view(message.method_string())};
  request.path = std::move(target->path);
  request.query = std::move(target->query);
  request.body = std::move(message.body());
  request.accept = std::string{to_view(message[http::field::accept])};
  request.local = local_;
  request.permitted = permitted_;
  name_caller(request);
  responder answer{make_sink(shared_, weak_from_this())};
  shared_->core->guarded(
      [&] { shared_->handler(std::move(request), std::move(answer)); });
}

void http_connection::hand_over(
    const std::shared_ptr<stream_connection>& stream) {
  if (phase_ != phase::answering)
    return stream->abort();
  phase_ = phase::handed_over;
  stream_ = stream;
  stream->begin(std::move(socket_), parser_->get().version() >= 11,
                [self = shared_from_this()] { self->abort(); });
  if (shared_->draining)
    stream->finish();
}

void http_connection::refuse_request(int status, error_code code,
                                     std::string_view message,
                                     std::string_view hint) {
  phase_ = phase::answering;
  last_reply_ = true;
  reply({status, json_content, error_body(code, message, hint)});
}

void http_connection::reply(http_reply reply) {
  if (phase_ != phase::answering)
    return;
  phase_ = phase::writing;
  last_reply_ = last_reply_ || shared_->draining || !parser_->is_done()
                || !parser_->keep_alive();
  outgoing_ = reply_head(reply, last_reply_, std::exchange(more_head_, {}));
  // The answer to a HEAD request has no body.
  if (!parser_->is_header_done() || parser_->get().method() != http::verb::head)
    outgoing_body_ = std::move(reply.body);
  else
    outgoing_body_.clear();
  limit(shared_->limits.write);
  // Both as they are: a body may be large.
  boost::asio::async_write(
      socket_,
      std::array{boost::asio::buffer(std::as_const(outgoing_)),
                 boost::asio::buffer(std::as_const(outgoing_body_))},
      [self = shared_from_this()](error ec, size_t) { self->on_written(ec); });
}

void http_connection::on_written(error ec) {
  if (phase_ == phase::closed)
    return;
  if (ec)
    return abort();
  outgoing_ = {};
  outgoing_body_ = {};
  if (last_reply_ || shared_->draining)
    return linger();
  next_request();
  if (incoming_.size() > 0)
    return parse();
  incoming_.shrink_to_fit();
  limit(shared_->limits.idle);
  read();
}

/// Closing with unread bytes in the socket would destroy the reply on its
/// way, so the client goes first.
void http_connection::linger() {
  phase_ = phase::lingering;
  socket_.shut_sending();
  limit(shared_->limits.grace);
  read();
}

void http_connection::drain() {
  if (phase_ == phase::waiting || phase_ == phase::queued)
    abort();
  else if (stream_)
    stream_->finish();
}

void http_connection::abort() {
  if (std::exchange(phase_, phase::closed) == phase::closed)
    return;
  const auto self = shared_from_this();
  timer_.cancel();
  close_now(socket_);
  shared_->hands.leave(std::exchange(hands_, 0));
  shared_->table.remove(this);
  if (const auto stream = std::exchange(stream_, nullptr))
    stream->abort();
  if (const auto session = session_.lock())
    session->abort("the server closed the connection");
  if (shared_->table.empty() && shared_->on_idle)
    shared_->on_idle();
}

} // namespace roscell
