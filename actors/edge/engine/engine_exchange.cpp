#include "actors/edge/engine/engine_exchange.hpp"

#include "actors/house/limits.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/error.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/http/error.hpp>

#include <cerrno>
#include <cstring>
#include <limits>
#include <utility>
#include <variant>

#include <fcntl.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>

namespace roscell {

namespace {

namespace http = boost::beast::http;
namespace local = boost::asio::local;

constexpr size_t piece_bytes = 64 * 1024;

bool has_room_for(const std::string& path) {
  return path.size() < sizeof(sockaddr_un::sun_path);
}

} // namespace

engine_exchange::engine_exchange(std::shared_ptr<io_core> core,
                                 std::string socket, engine_request what,
                                 engine_stream_callbacks calls)
    : core_(std::move(core)), path_(std::move(socket)), what_(std::move(what)),
      calls_(std::move(calls)), socket_(core_->context()),
      timer_(core_->context()) {
  parser_.eager(true);
  parser_.header_limit(limits::engine::header_bytes);
  parser_.body_limit(calls_.on_bytes ? std::numeric_limits<uint64_t>::max()
                                     : limits::engine::reply_bytes);
}

void engine_exchange::start() {
  if (over_)
    return;
  core_->adopt(shared_from_this());
  if (!has_room_for(path_))
    return finish(no_engine(path_, ENAMETOOLONG));
  timer_.expires_after(what_.limit);
  timer_.async_wait([self = shared_from_this()](error ec) {
    if (!ec && !self->over_)
      self->finish(edge_error{
          error_code::timeout,
          "the container engine on '" + self->path_ + "' did not answer within "
              + std::to_string(self->what_.limit.count() / 1000) + " s",
          "look into the engine's own log: journalctl -u docker"});
  });
  connect();
}

void engine_exchange::connect() {
  const int fd = ::socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  error ec;
  if (fd < 0)
    return finish(no_engine(path_, errno));
  socket_.assign({AF_UNIX, 0}, fd, ec);
  socket_.async_connect(local::stream_protocol::endpoint{path_},
                        [self = shared_from_this()](error connect_ec) {
                          if (!self->over_)
                            self->on_connected(connect_ec);
                        });
}

void engine_exchange::on_connected(error ec) {
  if (ec)
    return finish(no_engine(path_, ec.value()));
  if (!what_.file.empty()) {
    file_ = unique_fd{::open(what_.file.c_str(), O_RDONLY | O_CLOEXEC)};
    struct stat info {};
    if (!file_ || ::fstat(file_.get(), &info) != 0)
      return finish(edge_error{error_code::engine_failed,
                               "cannot read '" + what_.file.string()
                                   + "': " + std::strerror(errno),
                               ""});
    file_bytes_ = static_cast<uint64_t>(info.st_size);
  }
  write_head();
  // An engine may refuse before it has read everything.
  read();
}

std::string engine_exchange::head() const {
  auto text = what_.method + " " + what_.target
              + " HTTP/1.1\r\nHost: engine\r\nUser-Agent: roscell"
                "\r\nConnection: close\r\n";
  if (!what_.file.empty())
    text += "Content-Type: application/x-tar\r\nContent-Length: "
            + std::to_string(file_bytes_) + "\r\n";
  else if (what_.method != "GET" || !what_.body.empty())
    text += "Content-Type: application/json\r\nContent-Length: "
            + std::to_string(what_.body.size()) + "\r\n";
  return text + "\r\n";
}

void engine_exchange::write_head() {
  outgoing_ = head() + what_.body;
  boost::asio::async_write(socket_, boost::asio::buffer(outgoing_),
                           [self = shared_from_this()](error ec, size_t) {
                             // What went wrong is seen by reading.
                             if (!ec && !self->over_)
                               self->write_file();
                           });
}

void engine_exchange::write_file() {
  if (!file_)
    return;
  outgoing_.resize(piece_bytes);
  const auto n = ::read(file_.get(), outgoing_.data(), outgoing_.size());
  if (n <= 0) {
    file_.reset();
    return;
  }
  outgoing_.resize(static_cast<size_t>(n));
  boost::asio::async_write(socket_, boost::asio::buffer(outgoing_),
                           [self = shared_from_this()](error ec, size_t) {
                             if (!ec && !self->over_)
                               self->write_file();
                           });
}

void engine_exchange::read() {
  incoming_.resize(piece_bytes);
  socket_.async_read_some(boost::asio::buffer(incoming_),
                          [self = shared_from_this()](error ec, size_t bytes) {
                            if (!self->over_)
                              self->on_read(ec, bytes);
                          });
}

/// Beast's own reading gives a part of a body only when more has come.
engine_exchange::error engine_exchange::parse(std::string_view bytes) {
  error ec;
  pending_ += bytes;
  while (!pending_.empty() && !parser_.is_done() && !ec)
    pending_.erase(0, parser_.put(boost::asio::buffer(pending_), ec));
  return ec == http::error::need_more ? error{} : ec;
}

void engine_exchange::on_read(error ec, size_t bytes) {
  if (!ec)
    ec = parse({incoming_.data(), bytes});
  else if (ec == boost::asio::error::eof && parser_.got_some())
    parser_.put_eof(ec = error{});
  if (ec)
    return fail(ec == boost::asio::error::eof
                        || ec == http::error::partial_message
                    ? "it broke the connection"
                    : ec.message());
  if (parser_.is_header_done() && what_.endless)
    timer_.cancel();
  if (!pass_on())
    return;
  if (!parser_.is_done())
    return read();
  engine_reply reply;
  reply.status = static_cast<int>(parser_.get().result_int());
  reply.body = std::move(parser_.get().body());
  finish(std::move(reply));
}

/// Hands over what has come of a stream; false if that was its end.
bool engine_exchange::pass_on() {
  if (!calls_.on_bytes || !parser_.is_header_done())
    return true;
  if (parser_.get().result_int() / 100 != 2) {
    if (parser_.get().body().size() <= limits::engine::reply_bytes)
      return true;
    fail("its answer has no end");
    return false;
  }
  if (!std::exchange(opened_, true) && calls_.on_open)
    core_->guarded([&] { calls_.on_open(); });
  const auto bytes = std::exchange(parser_.get().body(), {});
  bool more = true;
  if (!over_ && !bytes.empty())
    core_->guarded([&] { more = calls_.on_bytes(bytes); });
  if (!over_ && !more)
    finish(engine_reply{static_cast<int>(parser_.get().result_int()), {}});
  return !over_;
}

void engine_exchange::fail(const std::string& why) {
  finish(edge_error{error_code::unreachable,
                    "the container engine on '" + path_ + "' went away: " + why,
                    "is it being restarted? journalctl -u docker tells"});
}

void engine_exchange::finish(engine_answer answer) {
  if (over_)
    return;
  const auto keep = shared_from_this();
  const auto on_end = std::move(calls_.on_end);
  close();
  if (on_end)
    core_->guarded([&] { on_end(std::move(answer)); });
}

void engine_exchange::cancel() {
  const auto keep = shared_from_this();
  close();
}

void engine_exchange::close() {
  over_ = true;
  timer_.cancel();
  close_now(socket_);
  file_.reset();
  // The callbacks may hold whoever holds this object.
  calls_ = {};
  core_->release(this);
}

void engine_exchange::on_io_stop() {
  cancel();
}

} // namespace roscell
