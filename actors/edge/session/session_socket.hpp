#pragma once

#include "actors/edge/io/stream_socket.hpp"
#include "actors/edge/session/limits.hpp"

#include <boost/beast/websocket/teardown.hpp>

#include <chrono>
#include <functional>
#include <memory>
#include <type_traits>
#include <utility>

/// INTERNAL to this folder. Beast ends a WebSocket by waiting for its peer to
/// close, without a time limit; this socket does not let it wait for long.
namespace roscell {

class session_socket : public stream_socket {
public:
  explicit session_socket(stream_socket&& socket)
      : stream_socket(std::move(socket)) {
    // nop
  }

  /// How long a peer may take to read the last frame and close.
  std::chrono::milliseconds linger_time = limits::session::linger;
};

/// Says that nothing more will be sent, and reads what still comes until the
/// peer closes or the time is over: closing with unread bytes would destroy
/// the last frame on its way. Calls `done` then, never at once.
void linger(session_socket& socket,
            std::function<void(boost::system::error_code)> done);

/// Beast finds these two by the type of the socket.
template <class Handler>
void async_teardown(boost::beast::role_type, session_socket& socket,
                    Handler&& handler) {
  auto shared =
      std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
  linger(socket, [shared](boost::system::error_code ec) { (*shared)(ec); });
}

inline void teardown(boost::beast::role_type, session_socket& socket,
                     boost::system::error_code& ec) {
  socket.close(ec);
}

} // namespace roscell
