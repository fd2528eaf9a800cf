#pragma once

#include "actors/edge/session/websocket_link.hpp"

#include <boost/beast/http/message.hpp>
#include <boost/beast/http/string_body.hpp>

#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace roscell {

/// INTERNAL to this folder: carries the frames of a handshake over a
/// WebSocket, for either side, within the time limit. What the frames mean is
/// the business of session_handshake. Io thread only.
class session_dialog : public io_component,
                       public std::enable_shared_from_this<session_dialog> {
public:
  using error = boost::system::error_code;

  session_dialog(std::shared_ptr<io_core> core, link_socket socket,
                 session_options options);

  /// Ends it at once with an error of code `timeout`.
  void abort(const std::string& why);

  void on_io_stop() override;

protected:
  /// Starts the clock and registers with the loop. Called first.
  void begin();

  /// What both ends of this connection know and nobody else: they prove by it
  /// that they mean this one, and make the keys of heartbeats of it. Empty: it
  /// is plain.
  std::string shared_secret();

  /// Whose it is at the other end, as TLS has proved; none: it is plain.
  std::optional<identity> proved_peer();

  /// What the other end has against this one's identity; none: nothing so far.
  std::optional<edge_error> refusal();

  /// The WebSocket is open: sends `first` if there is one, then takes turns.
  void exchange(std::string first);

  /// Takes what the peer's request or answer for a WebSocket has in its head.
  void hear_time(const boost::beast::http::fields& said);

  /// How far the time of this node is ahead of what the peer has said.
  int64_t ahead_ms() const {
    return ahead_ms_;
  }

  /// Takes one frame of the peer.
  virtual handshake_step receive(std::string_view frame) = 0;

  /// Exactly one of the two is called, once.
  virtual void on_established(websocket&& stream) = 0;
  virtual void on_refused(const edge_error& why) = 0;

  /// Reports `why` and closes, letting the peer read what was written.
  void refuse_peer(const edge_error& why);

  /// Reports `why` and breaks the connection.
  void fail(const edge_error& why);

  bool over() const {
    return reported_;
  }

  websocket& stream() {
    return stream_;
  }

  const std::shared_ptr<io_core>& core() const {
    return core_;
  }

  const session_options& options() const {
    return options_;
  }

  template <class Self>
  std::shared_ptr<Self> self_as() {
    return std::static_pointer_cast<Self>(shared_from_this());
  }

private:
  void read();
  void on_read(error ec);
  void take(handshake_step step);
  void conclude(const handshake_step& step);
  void fail_with(error ec);
  bool report_once();

  std::shared_ptr<io_core> core_;
  session_options options_;
  websocket stream_;
  boost::asio::steady_timer timer_;
  boost::beast::flat_buffer incoming_;
  std::string outgoing_;
  bool reported_ = false;
  int64_t ahead_ms_ = 0;
};

/// Why somebody is not whom the certificate speaks of that he has shown; none:
/// he is.
std::optional<edge_error> mismatch(const identity& proved,
                                   const std::string& node,
                                   const std::string& uuid);

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

  session_accept(std::shared_ptr<io_core> core, link_socket socket,
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
