#include "actors/edge/http/http_connection.hpp"
#include "actors/edge/http/http_shared.hpp"
#include "actors/edge/trust/limits.hpp"
#include "actors/edge/trust/site_identity.hpp"

#include <utility>

/// How a connection proves whose it is, before a byte of a request is read.
namespace roscell {

void http_connection::prove() {
  phase_ = phase::proving;
  limit(limits::trust::handshake);
  // Who says nothing takes nobody's place.
  socket_.bare().async_wait(
      stream_socket::wait_read, [self = shared_from_this()](error ec) {
        if (self->phase_ != phase::proving)
          return;
        if (ec)
          return self->abort();
        self->hands_ =
            self->shared_->hands.enter(peer_of(self->socket_.bare()).address,
                                       [weak = self->weak_from_this()] {
                                         if (const auto alive = weak.lock())
                                           alive->shake_hands();
                                       });
      });
}

void http_connection::shake_hands() {
  limit(limits::trust::handshake);
  socket_.secure(
      shared_->identity, tls_engine::role::accepts,
      [self = shared_from_this()](const auto& why) { self->on_proved(why); });
}

/// Without an identity of the site nobody learns anything here.
void http_connection::on_proved(const std::optional<distrusted>& why) {
  if (phase_ != phase::proving)
    return;
  shared_->hands.leave(std::exchange(hands_, 0));
  if (!why) {
    peer_ = socket_.tls()->peer();
    newcomer_ = socket_.tls()->protocol() == entry_protocol;
  }
  if (peer_ || (newcomer_ && shared_->identity->expects_newcomers()))
    return begin_requests();
  const distrusted nobody{
      distrust::no_certificate, "it shows no certificate", {}};
  if (shared_->on_distrusted)
    shared_->core->guarded([&] {
      shared_->on_distrusted(peer_of(socket_.bare()).address,
                             why.value_or(nobody));
    });
  // What was said of it by TLS is on its way.
  linger();
}

} // namespace roscell
