#include "actors/edge/http/http_stream_connection.hpp"

#include "actors/edge/http/http_types.hpp"
#include "actors/edge/http/limits.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/write.hpp>

#include <cstdio>
#include <utility>

namespace roscell {

namespace {

class stream_handle : public http_stream {
public:
  explicit stream_handle(std::shared_ptr<stream_connection> stream)
      : stream_(std::move(stream)) {
    // nop
  }

  ~stream_handle() override {
    stream_->close();
  }

  bool write(std::string chunk) override {
    return stream_->write(std::move(chunk));
  }

  void on_closed(std::function<void()> callback) override {
    stream_->on_closed(std::move(callback));
  }

  void close() override {
    stream_->close();
  }

  void break_off() override {
    stream_->break_off();
  }

private:
  std::shared_ptr<stream_connection> stream_;
};

std::string chunk_head(size_t size) {
  std::array<char, 24> text{};
  const int length = std::snprintf(text.data(), text.size(), "%zx\r\n", size);
  return {text.data(), static_cast<size_t>(length)};
}

std::string head(const std::string& content_type, bool chunked) {
  return "HTTP/1.1 200 OK\r\nContent-Type: " + content_type
         + "\r\nCache-Control: no-store\r\nConnection: close\r\n"
         + (chunked ? "Transfer-Encoding: chunked\r\n\r\n" : "\r\n");
}

std::string cut_note() {
  return "event: error\ndata: "
         + error_body(error_code::timeout,
                      "the stream was cut, its reader is too slow",
                      "connect again")
         + "\n\n";
}

} // namespace

stream_connection::stream_connection(std::shared_ptr<io_core> core,
                                     const http_limits& limits,
                                     std::string content_type)
    : core_(std::move(core)), limits_(limits),
      content_type_(std::move(content_type)), timer_(core_->context()) {
  // nop
}

std::shared_ptr<http_stream>
stream_connection::make_handle(std::shared_ptr<stream_connection> stream) {
  return std::make_shared<stream_handle>(std::move(stream));
}

void stream_connection::begin(link_socket socket, bool chunked,
                              std::function<void()> on_over) {
  if (over_)
    return on_over();
  socket_.emplace(std::move(socket));
  chunked_ = chunked;
  on_over_ = std::move(on_over);
  keep_alive(socket_->bare());
  put(head(content_type_, chunked));
  for (const auto& chunk : std::exchange(early_, {}))
    append(chunk);
  watch();
  if (std::exchange(finish_early_, false))
    finish();
  flush();
}

bool stream_connection::write(std::string chunk) {
  if (!open_)
    return false;
  const auto size = chunk.size();
  if (size == 0)
    return true;
  if (queued_bytes_.fetch_add(size) + size > limits_.stream_bytes) {
    queued_bytes_ -= size;
    open_ = false;
    core_->post([self = shared_from_this()] { self->cut(); });
    return false;
  }
  core_->post([self = shared_from_this(), chunk = std::move(chunk)] {
    self->queued_bytes_ -= chunk.size();
    self->enqueue(chunk);
  });
  return true;
}

void stream_connection::enqueue(const std::string& chunk) {
  if (last_ || over_)
    return;
  // What another thread has written can overtake the handing over.
  if (!socket_)
    return early_.push_back(chunk);
  append(chunk);
  flush();
}

void stream_connection::append(const std::string& chunk) {
  put(chunked_ ? chunk_head(chunk.size()) + chunk + "\r\n" : chunk);
}

void stream_connection::put(const std::string& framed) {
  queued_bytes_ += framed.size();
  waiting_ += framed;
}

void stream_connection::cut() {
  if (last_ || over_)
    return;
  cut_ = true;
  queued_bytes_ -= waiting_.size();
  waiting_.clear();
  if (content_type_ == event_stream_content)
    append(cut_note());
  finish();
}

void stream_connection::close() {
  open_ = false;
  core_->post([self = shared_from_this()] { self->finish(); });
}

void stream_connection::break_off() {
  open_ = false;
  core_->post([self = shared_from_this()] {
    self->cut_ = true;
    self->finish();
  });
}

void stream_connection::finish() {
  if (last_ || over_)
    return;
  open_ = false;
  if (!socket_) {
    finish_early_ = true;
    return;
  }
  last_ = true;
  // A stream that was cut has no proper end, and its client can see that.
  if (chunked_ && !cut_)
    put("0\r\n\r\n");
  limit(limits_.write);
  flush();
}

void stream_connection::flush() {
  if (!socket_ || writing_ || over_)
    return;
  if (in_flight_.empty())
    in_flight_.swap(waiting_);
  if (!in_flight_.empty()) {
    writing_ = true;
    boost::asio::async_write(*socket_, boost::asio::buffer(in_flight_),
                             [self = shared_from_this()](error ec, size_t) {
                               self->on_written(ec);
                             });
  } else if (last_ && !std::exchange(shut_down_, true)) {
    // The client closes when it has read all; `watch` sees that.
    socket_->shut_sending();
    limit(limits_.grace);
  }
}

void stream_connection::on_written(error ec) {
  writing_ = false;
  queued_bytes_ -= in_flight_.size();
  in_flight_.clear();
  if (ec)
    return abort();
  flush();
}

void stream_connection::watch() {
  socket_->async_read_some(boost::asio::buffer(ignored_),
                           [self = shared_from_this()](error ec, size_t size) {
                             self->on_read(ec, size);
                           });
}

void stream_connection::on_read(error ec, size_t size) {
  ignored_bytes_ += size;
  if (ec || ignored_bytes_ > limits::http::stream_ignored_bytes)
    return abort();
  if (!over_)
    watch();
}

void stream_connection::limit(std::chrono::milliseconds time) {
  timer_.expires_after(time);
  timer_.async_wait([self = shared_from_this()](error ec) {
    if (!ec)
      self->abort();
  });
}

void stream_connection::on_closed(std::function<void()> callback) {
  core_->post([self = shared_from_this(), callback = std::move(callback)] {
    if (self->over_)
      self->core_->guarded(callback);
    else
      self->on_closed_ = callback;
  });
}

void stream_connection::abort() {
  if (std::exchange(over_, true))
    return;
  open_ = false;
  timer_.cancel();
  if (socket_)
    close_now(*socket_);
  if (const auto over = std::exchange(on_over_, nullptr))
    over();
  if (const auto closed = std::exchange(on_closed_, nullptr))
    core_->guarded(closed);
}

} // namespace roscell
