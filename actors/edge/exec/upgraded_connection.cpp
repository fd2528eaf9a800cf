#include "actors/edge/exec/upgraded_connection.hpp"

#include "actors/edge/engine/limits.hpp"
#include "actors/edge/exec/engine_frames.hpp"
#include "actors/edge/exec/exec_channel.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <boost/asio/write.hpp>

#include <utility>

namespace roscell {

namespace {

namespace asio = boost::asio;

constexpr int upgraded = 101;
constexpr int ok = 200;

} // namespace

upgraded_connection::upgraded_connection(std::shared_ptr<io_core> core,
                                         callbacks calls)
    : core_(std::move(core)), calls_(std::move(calls)),
      socket_(core_->context()) {
  // nop
}

void upgraded_connection::open(const std::string& socket,
                               const std::string& target,
                               const std::string& body) {
  const auto request = "POST " + target
                       + " HTTP/1.1\r\nHost: localhost\r\nUser-Agent: roscell"
                         "\r\nConnection: Upgrade\r\nUpgrade: tcp\r\n"
                         "Content-Type: application/json\r\nContent-Length: "
                       + std::to_string(body.size()) + "\r\n\r\n" + body;
  open_unix(socket_);
  socket_.async_connect(asio::local::stream_protocol::endpoint{socket},
                        [self = shared_from_this(), request](error ec) {
                          if (self->over_)
                            return;
                          if (ec)
                            return self->end(0, ec.message());
                          self->send_request(request);
                        });
}

void upgraded_connection::send_request(const std::string& request) {
  writing_ = request;
  asio::async_write(socket_, asio::buffer(writing_),
                    [self = shared_from_this()](error, size_t) {
                      // What went wrong is seen by reading.
                    });
  read();
}

void upgraded_connection::read() {
  if (over_ || std::exchange(reading_, true))
    return;
  buffer_.resize(exec_part_bytes);
  socket_.async_read_some(asio::buffer(buffer_),
                          [self = shared_from_this()](error ec, size_t size) {
                            self->reading_ = false;
                            if (!self->over_)
                              self->on_read(ec, {self->buffer_.data(), size});
                          });
}

void upgraded_connection::on_read(error ec, std::string_view bytes) {
  if (open_)
    return ec ? end(0, {}) : calls_.on_bytes(bytes);
  head_ += bytes;
  const auto head = read_answer_head(head_);
  if (head.bytes == 0 && !ec && head_.size() < limits::engine::header_bytes)
    return read();
  if (head.status != upgraded && head.status != ok)
    return end(head.status, head_.substr(head.bytes));
  open_ = true;
  calls_.on_open();
  // What is called may have closed it.
  if (!over_)
    calls_.on_bytes(std::string_view{head_}.substr(head.bytes));
}

void upgraded_connection::write(std::string bytes,
                                std::function<void(bool)> then) {
  writing_ = std::move(bytes);
  asio::async_write(
      socket_, asio::buffer(writing_),
      [self = shared_from_this(), then = std::move(then)](error ec, size_t) {
        if (!self->over_)
          then(!ec);
      });
}

void upgraded_connection::end_input() {
  error ignored;
  socket_.shutdown(stream_socket::shutdown_send, ignored);
}

void upgraded_connection::end(int status, std::string text) {
  const auto self = shared_from_this();
  const auto on_end = calls_.on_end;
  close();
  on_end(status, std::move(text));
}

void upgraded_connection::close() {
  over_ = true;
  // What is being called at this moment is not to be let go of under itself.
  core_->post([calls = std::exchange(calls_, {})] {});
  close_now(socket_);
}

} // namespace roscell
