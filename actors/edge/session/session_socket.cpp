#include "actors/edge/session/websocket_link.hpp"

#include <boost/asio/buffer.hpp>
#include <boost/asio/steady_timer.hpp>

#include <array>

namespace roscell {

namespace {

using error = boost::system::error_code;

/// Reads and forgets. The handler behind `done_` keeps the socket alive.
class lingering : public std::enable_shared_from_this<lingering> {
public:
  lingering(session_socket& socket, std::function<void(error)> done)
      : socket_(socket), timer_(socket.get_executor(), socket.linger_time),
        done_(std::move(done)) {
    // nop
  }

  void run() {
    socket_.shut_sending();
    timer_.async_wait([self = shared_from_this()](error ec) {
      if (!ec && self->done_)
        close_now(self->socket_);
    });
    read();
  }

private:
  void read() {
    socket_.async_read_some(boost::asio::buffer(forgotten_),
                            [self = shared_from_this()](error ec, size_t) {
                              if (!ec)
                                return self->read();
                              self->timer_.cancel();
                              std::exchange(self->done_, nullptr)({});
                            });
  }

  session_socket& socket_;
  boost::asio::steady_timer timer_;
  std::function<void(error)> done_;
  std::array<char, 2048> forgotten_{};
};

} // namespace

void linger(session_socket& socket,
            std::function<void(boost::system::error_code)> done) {
  std::make_shared<lingering>(socket, std::move(done))->run();
}

} // namespace roscell
