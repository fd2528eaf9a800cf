#include "actors/edge/session/session_accept.hpp"

#include <utility>

namespace roscell {

session_accept::session_accept(std::shared_ptr<io_core> core,
                               stream_socket socket,
                               std::shared_ptr<const session_acceptor> acceptor,
                               hooks reported)
    : session_dialog(std::move(core), std::move(socket), acceptor->options),
      acceptor_(std::move(acceptor)), hooks_(std::move(reported)),
      peer_(peer_of(stream().next_layer())),
      handshake_(acceptor_->identity, acceptor_->site.text()) {
  tune_for_session(stream().next_layer(), options().user_timeout);
}

void session_accept::run(upgrade_request request) {
  request_ = std::move(request);
  hear_time(request_);
  begin();
  stream().async_accept(request_, [self = self_as<session_accept>()](error ec) {
    if (self->over())
      return;
    if (ec)
      self->fail({error_code::schema_violation,
                  "the request for a WebSocket is "
                  "invalid: "
                      + ec.message(),
                  ""});
    else
      self->exchange({});
  });
}

handshake_step session_accept::receive(std::string_view frame) {
  return handshake_.receive(frame);
}

void session_accept::on_established(websocket&& stream) {
  const auto& hello = handshake_.peer();
  established_session session;
  session.peer = {hello.node, hello.uuid, hello.version, peer_.address,
                  peer_.port, "",         hello.epoch,   hello.role};
  session.agreement = handshake_.agreement();
  session.ahead_ms = ahead_ms();
  hooks_.on_decided(true);
  session.link = websocket_link::make(core(), std::move(stream), options(),
                                      std::move(hooks_.on_gone));
  if (acceptor_->on_session)
    core()->guarded([&] { acceptor_->on_session(std::move(session)); });
}

void session_accept::on_refused(const edge_error& why) {
  hooks_.on_decided(false);
  if (acceptor_->on_refused)
    acceptor_->on_refused(peer_.address, why);
}

} // namespace roscell
