#pragma once

#include "actors/edge/session/session_dialog.hpp"

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include <functional>
#include <memory>

namespace roscell {

/// INTERNAL to this folder: the acceptor's side, from a request that asked
/// for a WebSocket.
class session_accept : public session_dialog {
public:
  using upgrade_request =
      boost::beast::http::request<boost::beast::http::string_body>;

  /// `on_decided(true)` is called before the session is given to its owner,
  /// `on_decided(false)` when there will be none; `on_gone` follows the
  /// former when the session ends.
  struct hooks {
    std::function<void(bool)> on_decided;
    std::function<void()> on_gone;
  };

  session_accept(std::shared_ptr<io_core> core, stream_socket socket,
                 std::shared_ptr<const session_acceptor> acceptor,
                 hooks reported);

  void run(upgrade_request request);

protected:
  handshake_step receive(std::string_view frame) override;
  void on_established(websocket&& stream) override;
  void on_refused(const edge_error& why) override;

private:
  std::shared_ptr<const session_acceptor> acceptor_;
  hooks hooks_;
  socket_address peer_;
  upgrade_request request_;
  acceptor_handshake handshake_;
};

} // namespace roscell
