#include "actors/edge/http/client/http_exchange.hpp"

#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/plain_text.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

#include <algorithm>
#include <cerrno>
#include <limits>
#include <utility>

namespace roscell {

namespace {

namespace http = boost::beast::http;
namespace ip = boost::asio::ip;
namespace local = boost::asio::local;

constexpr size_t piece_bytes = 64 * 1024;

constexpr uint64_t no_limit = std::numeric_limits<uint64_t>::max();

bool is_clean(std::string_view text) {
  return std::none_of(text.begin(), text.end(), is_control);
}

bool is_tcp_address(const http_endpoint& to) {
  boost::system::error_code ec;
  ip::make_address_v4(to.address, ec);
  return !ec && to.port != 0;
}

/// Why a call cannot be made; empty if it can.
std::string objection_to(const http_call& what) {
  if (what.target.find(' ') != std::string::npos || !parse_target(what.target))
    return "'" + what.target + "' is no path of an HTTP request";
  if (!is_clean(what.target) || !is_clean(what.to.token))
    return "the path or the token has a control character in it";
  if (what.to.socket_path.empty() && !is_tcp_address(what.to))
    return "'" + what.to.name() + "' is no IPv4 address and port";
  return {};
}

http_reply take_reply(http::response<http::string_body>& message) {
  const auto type = message[http::field::content_type];
  return {static_cast<int>(message.result_int()),
          {type.data(), type.size()},
          std::move(message.body())};
}

} // namespace

http_exchange::http_exchange(std::shared_ptr<io_core> core, http_call what,
                             http_callbacks calls)
    : core_(std::move(core)), what_(std::move(what)), calls_(std::move(calls)),
      socket_(core_), timer_(core_->context()) {
  expect_reply();
}

http_exchange::~http_exchange() {
  if (calls_.on_end)
    core_->guarded([this] {
      calls_.on_end(http_failure{http_failure::kind::stopped, {}, 0});
    });
}

void http_exchange::expect_reply() {
  parser_.emplace();
  parser_->eager(true);
  parser_->header_limit(static_cast<uint32_t>(what_.max_header_bytes));
  parser_->body_limit(calls_.on_bytes ? no_limit : what_.max_reply_bytes);
}

void http_exchange::start() {
  if (over_)
    return;
  core_->adopt(shared_from_this());
  if (auto objection = objection_to(what_); !objection.empty())
    return fail(http_failure::kind::bad_call, std::move(objection));
  limit_time();
  connect();
}

void http_exchange::limit_time() {
  timer_.expires_after(what_.timeout);
  timer_.async_wait([self = shared_from_this()](error ec) {
    if (!ec)
      self->fail(http_failure::kind::timeout);
  });
}

void http_exchange::connect() {
  boost::asio::generic::stream_protocol::endpoint whom;
  if (what_.to.socket_path.empty()) {
    open_tcp(socket_.bare());
    if (!what_.from.empty()) {
      error ec;
      socket_.bare().bind(ip::tcp::endpoint{ip::make_address_v4(what_.from), 0},
                          ec);
      if (ec)
        return finish(
            http_failure{http_failure::kind::no_connection, {}, ec.value()});
    }
    whom =
        ip::tcp::endpoint{ip::make_address_v4(what_.to.address), what_.to.port};
  } else {
    if (what_.to.socket_path.size() >= sizeof(sockaddr_un::sun_path))
      return finish(
          http_failure{http_failure::kind::no_connection, {}, ENAMETOOLONG});
    open_unix(socket_.bare());
    whom = local::stream_protocol::endpoint{what_.to.socket_path};
  }
  socket_.bare().async_connect(whom, [self = shared_from_this()](error ec) {
    if (!self->over_)
      self->on_connected(ec);
  });
}

void http_exchange::on_connected(error ec) {
  if (ec)
    return finish(
        http_failure{http_failure::kind::no_connection, {}, ec.value()});
  if (!what_.file.empty() && !open_file())
    return finish(http_failure{http_failure::kind::no_file, {}, errno});
  if (what_.to.socket_path.empty()) {
    send_at_once(socket_.bare());
    keep_alive(socket_.bare());
    if (what_.to.identity)
      return secure();
  }
  ask();
}

void http_exchange::secure() {
  const auto* protocol = what_.to.protocol;
  socket_.secure(
      what_.to.identity, tls_engine::role::connects,
      [self = shared_from_this()](const auto& why) {
        if (!self->over_)
          self->on_secured(why);
      },
      protocol == nullptr ? http_protocol : protocol);
}

void http_exchange::on_secured(const std::optional<distrusted>& why) {
  if (why)
    return fail(http_failure::kind::distrusted, why->text);
  const auto who = socket_.tls()->peer();
  if (!who || (!what_.to.uuid.empty() && who->uuid != what_.to.uuid))
    return fail(http_failure::kind::distrusted,
                who ? "it is " + text_of(*who) + " with UUID " + who->uuid
                    : "it shows no certificate");
  ask();
}

void http_exchange::ask() {
  write_head();
  // The server may refuse before it has read everything.
  read();
}

bool http_exchange::open_file() {
  file_ = unique_fd{::open(what_.file.c_str(), O_RDONLY | O_CLOEXEC)};
  struct stat info {};
  if (!file_ || ::fstat(file_.get(), &info) != 0)
    return false;
  file_bytes_ = static_cast<uint64_t>(info.st_size);
  return true;
}

std::string http_exchange::head() const {
  const bool tcp = what_.to.socket_path.empty();
  auto text = what_.method + " " + what_.target
              + " HTTP/1.1\r\nHost: " + (tcp ? what_.to.name() : "localhost")
              + "\r\nUser-Agent: roscell\r\nConnection: close\r\n";
  if (tcp && !what_.to.token.empty())
    text += "Authorization: Bearer " + what_.to.token + "\r\n";
  for (const auto& [name, value] : what_.headers)
    text += name + ": " + value + "\r\n";
  if (file_)
    text += "Content-Type: application/x-tar\r\nContent-Length: "
            + std::to_string(file_bytes_) + "\r\n";
  else if (what_.method != "GET" || !what_.body.empty())
    text += "Content-Type: application/json\r\nContent-Length: "
            + std::to_string(what_.body.size()) + "\r\n";
  return text + "\r\n";
}

void http_exchange::write_head() {
  outgoing_ = head() + what_.body;
  boost::asio::async_write(socket_, boost::asio::buffer(outgoing_),
                           [self = shared_from_this()](error ec, size_t) {
                             // What went wrong is seen by reading.
                             if (!ec && !self->over_)
                               self->write_file();
                           });
}

void http_exchange::write_file() {
  if (!file_)
    return;
  outgoing_.resize(piece_bytes);
  const auto n = ::read(file_.get(), outgoing_.data(), outgoing_.size());
  if (n <= 0)
    return file_.reset();
  outgoing_.resize(static_cast<size_t>(n));
  boost::asio::async_write(socket_, boost::asio::buffer(outgoing_),
                           [self = shared_from_this()](error ec, size_t) {
                             if (!ec && !self->over_)
                               self->write_file();
                           });
}

void http_exchange::read() {
  incoming_.resize(piece_bytes);
  socket_.async_read_some(boost::asio::buffer(incoming_),
                          [self = shared_from_this()](error ec, size_t bytes) {
                            if (!self->over_)
                              self->on_read(ec, bytes);
                          });
}

/// Beast's own reading gives a part of a body only when more has come.
http_exchange::error http_exchange::parse(std::string_view bytes) {
  error ec;
  pending_ += bytes;
  while (!pending_.empty() && !parser_->is_done() && !ec) {
    pending_.erase(0, parser_->put(boost::asio::buffer(pending_), ec));
    // "100 Continue" comes before the reply.
    if (parser_->is_done() && parser_->get().result_int() < 200)
      expect_reply();
  }
  return ec == http::error::need_more ? error{} : ec;
}

void http_exchange::on_read(error ec, size_t bytes) {
  if (!ec)
    ec = parse({incoming_.data(), bytes});
  else if (ec == boost::asio::error::eof && parser_->got_some())
    parser_->put_eof(ec = error{});
  if (ec)
    return on_broken(ec);
  if (parser_->is_header_done() && what_.endless)
    timer_.cancel();
  if (!pass_on())
    return;
  if (!parser_->is_done())
    return read();
  finish(take_reply(parser_->get()));
}

void http_exchange::on_broken(error ec) {
  if (const auto why = socket_.refusal())
    return fail(http_failure::kind::distrusted,
                "it has refused this identity: " + why->text);
  if (ec == http::error::body_limit)
    fail(http_failure::kind::too_long);
  else if (ec.category() == boost::asio::error::get_misc_category()
           || ec.category() == boost::system::system_category()
           || ec == http::error::partial_message)
    fail(http_failure::kind::cut_off, ec.message());
  else
    fail(http_failure::kind::broken, ec.message());
}

bool http_exchange::is_stream() const {
  return calls_.on_bytes && parser_->get().result_int() / 100 == 2;
}

/// Hands over what has come of a stream; false if that was its end.
bool http_exchange::pass_on() {
  if (!calls_.on_bytes || !parser_->is_header_done())
    return true;
  if (!is_stream()) {
    if (parser_->get().body().size() <= what_.max_reply_bytes)
      return true;
    fail(http_failure::kind::too_long);
    return false;
  }
  if (!std::exchange(opened_, true) && calls_.on_open)
    core_->guarded([&] { calls_.on_open(); });
  const auto bytes = std::exchange(parser_->get().body(), {});
  bool more = true;
  if (!over_ && !bytes.empty())
    core_->guarded([&] { more = calls_.on_bytes(bytes); });
  if (!over_ && !more)
    finish(take_reply(parser_->get()));
  return !over_;
}

void http_exchange::fail(http_failure::kind what, std::string reason) {
  finish(http_failure{what, std::move(reason), 0});
}

void http_exchange::finish(http_outcome outcome) {
  if (over_)
    return;
  const auto keep = shared_from_this();
  const auto on_end = std::move(calls_.on_end);
  close();
  if (on_end)
    core_->guarded([&] { on_end(std::move(outcome)); });
}

void http_exchange::cancel() {
  if (over_)
    return;
  const auto keep = shared_from_this();
  close();
}

void http_exchange::close() {
  over_ = true;
  timer_.cancel();
  close_now(socket_);
  file_.reset();
  // The callbacks may hold whoever holds this object.
  calls_ = {};
  core_->release(this);
}

void http_exchange::on_io_stop() {
  fail(http_failure::kind::stopped);
}

} // namespace roscell
