#include "actors/edge/trust/link_socket.hpp"

#include <boost/asio/error.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/write.hpp>

#include <array>
#include <cstring>

namespace roscell {

namespace {

namespace asio = boost::asio;

/// On the stack: a connection that is silent holds none.
constexpr size_t read_bytes = 16 * 1024;

} // namespace

// -- the handshake ------------------------------------------------------------

void link_core::secure(const std::shared_ptr<site_identity>& own,
                       tls_engine::role as, verdict done,
                       const char* protocol) {
  error ignored;
  bare.non_blocking(true, ignored);
  own_ = own;
  on_secured_ = std::move(done);
  // Whoever accepts has nothing to compute before something came.
  auto made = std::make_shared<tls_engine>(own->settings(), as, protocol);
  if (as == tls_engine::role::accepts)
    hear_hands(made);
  else
    on_computed(made);
}

/// What is computed knows no socket, so whatever becomes of this one meanwhile
/// is of no matter to it.
void link_core::compute(engine x, std::string bytes) {
  own_->handshakes().run([x = std::move(x), bytes = std::move(bytes), io = io_,
                          weak = weak_from_this()]() mutable {
    x->take(bytes);
    io->post([x = std::move(x), weak] {
      if (const auto self = weak.lock())
        self->on_computed(x);
    });
  });
}

void link_core::on_computed(const engine& x) {
  // Closed meanwhile.
  if (!on_secured_)
    return;
  outgoing_ = x->give();
  if (outgoing_.empty())
    return x->is_open() || x->problem() ? conclude(x, x->problem())
                                        : hear_hands(x);
  asio::async_write(bare, asio::buffer(outgoing_),
                    [self = shared_from_this(), x](error ec, size_t) {
                      self->outgoing_ = {};
                      if (!self->on_secured_)
                        return;
                      if (x->problem() || x->is_open())
                        return self->conclude(x, x->problem());
                      if (ec)
                        return self->conclude(
                            x,
                            distrusted{distrust::no_certificate,
                                       "the connection broke: " + ec.message(),
                                       {}});
                      self->hear_hands(x);
                    });
}

void link_core::hear_hands(const engine& x) {
  bare.async_wait(
      stream_socket::wait_read, [self = shared_from_this(), x](error ec) {
        if (!self->on_secured_)
          return;
        std::array<char, read_bytes> room;
        const auto size = ec ? 0 : self->bare.read_some(asio::buffer(room), ec);
        if (ec == asio::error::would_block)
          return self->hear_hands(x);
        if (ec)
          return self->conclude(
              x, distrusted{distrust::no_certificate,
                            "the connection ended in the middle of TLS",
                            {}});
        self->compute(x, {room.data(), size});
      });
}

void link_core::conclude(const engine& x,
                         const std::optional<distrusted>& why) {
  if (!why) {
    tls = x;
    watch_peer();
  }
  const auto done = std::exchange(on_secured_, nullptr);
  io_->guarded([&] { done(why); });
}

/// Who is revoked loses what he has, not only what he would begin. Whoever uses
/// this sees it as the other end's doing.
void link_core::watch_peer() {
  const auto chain = tls->peer_chain();
  if (chain.empty())
    return;
  watch_ = own_->watch(chain.front(), [io = io_, weak = weak_from_this()] {
    io->post([weak] {
      error ignored;
      if (const auto self = weak.lock())
        self->bare.shutdown(stream_socket::shutdown_both, ignored);
    });
  });
}

void link_core::forget_watch() {
  if (const auto ticket = std::exchange(watch_, std::nullopt))
    own_->unwatch(*ticket);
}

// -- what is said inside ------------------------------------------------------

/// What is there already; none: nothing is, and the connection goes on.
std::optional<link_core::error> link_core::decrypt(asio::mutable_buffer into,
                                                   size_t& size) {
  const auto text = tls->read(into.size());
  size = text.size();
  std::memcpy(into.data(), text.data(), size);
  if (size > 0)
    return error{};
  if (tls->has_ended())
    return error{asio::error::eof};
  if (tls->problem())
    return error{asio::error::connection_reset};
  return std::nullopt;
}

void link_core::read(asio::mutable_buffer into, action done) {
  size_t size = 0;
  const auto result = into.size() > 0 ? decrypt(into, size) : error{};
  if (!result)
    return wait_for_bytes(into, std::move(done));
  asio::post(bare.get_executor(),
             [self = shared_from_this(), done = std::move(done), ec = *result,
              size] { done(ec, size); });
}

/// Feeds what has come. An end that was not said inside is none: somebody may
/// have cut it off.
bool link_core::take_bytes(const engine& x, error& ec) {
  std::array<char, read_bytes> room;
  const auto size = bare.read_some(asio::buffer(room), ec);
  if (ec == asio::error::eof)
    ec = asio::error::connection_reset;
  if (ec)
    return false;
  x->take({room.data(), size});
  return true;
}

void link_core::wait_for_bytes(asio::mutable_buffer into, action done) {
  bare.async_wait(stream_socket::wait_read,
                  [self = shared_from_this(), into,
                   done = std::move(done)](error ec) mutable {
                    if (ec)
                      return done(ec, 0);
                    size_t size = 0;
                    const bool came = self->take_bytes(self->tls, ec);
                    if (!came && ec != asio::error::would_block)
                      return done(ec, 0);
                    const auto result = self->decrypt(into, size);
                    if (result)
                      return done(*result, size);
                    self->wait_for_bytes(into, std::move(done));
                  });
}

void link_core::write(std::string_view bytes, action done) {
  tls->write(bytes);
  outgoing_ = tls->give();
  if (tls->problem() || outgoing_.empty()) {
    const error ec = bytes.empty() ? error{} : asio::error::connection_reset;
    return asio::post(bare.get_executor(),
                      [self = shared_from_this(), done = std::move(done), ec] {
                        done(ec, 0);
                      });
  }
  asio::async_write(bare, asio::buffer(outgoing_),
                    [self = shared_from_this(), done = std::move(done),
                     size = bytes.size()](error ec, size_t) {
                      self->outgoing_ = {};
                      done(ec, ec ? 0 : size);
                    });
}

void link_core::shut_sending() {
  error ignored;
  if (tls && outgoing_.empty()) {
    tls->close();
    const auto last = tls->give();
    bare.write_some(asio::buffer(last), ignored);
  }
  bare.shutdown(stream_socket::shutdown_send, ignored);
}

void link_core::close() {
  // It may hold whoever holds this, until the end of this call.
  const auto forgotten = std::exchange(on_secured_, nullptr);
  forget_watch();
  close_now(bare);
}

} // namespace roscell
