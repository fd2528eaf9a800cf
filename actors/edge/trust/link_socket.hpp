#pragma once

#include "actors/edge/io/io_core.hpp"
#include "actors/edge/io/sockets.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/edge/trust/tls_engine.hpp"

#include <boost/asio/buffer.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>

namespace roscell {

/// INTERNAL to the edge: the machinery of a link_socket. Io thread only.
class link_core : public std::enable_shared_from_this<link_core> {
public:
  using error = boost::system::error_code;
  using action = std::function<void(error, size_t)>;
  using verdict = std::function<void(const std::optional<distrusted>&)>;

  link_core(std::shared_ptr<io_core> io, stream_socket socket)
      : bare(std::move(socket)), io_(std::move(io)) {
    // nop
  }

  void secure(const std::shared_ptr<site_identity>& own, tls_engine::role as,
              verdict done, const char* protocol);
  void read(boost::asio::mutable_buffer into, action done);
  void write(std::string_view bytes, action done);
  void shut_sending();
  void close();

  ~link_core() {
    forget_watch();
  }

  link_core(const link_core&) = delete;
  link_core& operator=(const link_core&) = delete;

  stream_socket bare;
  std::shared_ptr<tls_engine> tls; ///< Null: what is said is plain.

private:
  using engine = std::shared_ptr<tls_engine>;

  void compute(engine x, std::string bytes);
  void on_computed(const engine& x);
  void hear_hands(const engine& x);
  void conclude(const engine& x, const std::optional<distrusted>& why);
  void wait_for_bytes(boost::asio::mutable_buffer into, action done);
  void watch_peer();
  void forget_watch();
  bool take_bytes(const engine& x, error& ec);
  std::optional<error> decrypt(boost::asio::mutable_buffer into, size_t& size);

  std::shared_ptr<io_core> io_;
  std::shared_ptr<site_identity> own_;
  verdict on_secured_; ///< May hold whoever owns this.
  std::optional<uint64_t> watch_;
  std::string outgoing_;
};

/// INTERNAL to the edge: a stream over a socket, plain, or by TLS 1.3 once
/// `secure` has come to a good end. An Asio stream of which one reads and one
/// writes at a time. Io thread only.
class link_socket {
public:
  using error = boost::system::error_code;
  using executor_type = stream_socket::executor_type;

  link_socket(std::shared_ptr<io_core> io, stream_socket socket)
      : core_(std::make_shared<link_core>(std::move(io), std::move(socket))) {
    // nop
  }

  explicit link_socket(const std::shared_ptr<io_core>& io)
      : link_socket(io, stream_socket{io->context()}) {
    // nop
  }

  ~link_socket() {
    close();
  }

  link_socket(link_socket&&) = default;
  link_socket& operator=(link_socket&&) = delete;

  executor_type get_executor() {
    return core_->bare.get_executor();
  }

  /// To open, connect and tune it.
  stream_socket& bare() {
    return core_->bare;
  }

  /// Shakes hands, with what is computed on a thread of `own`. Calls `done`
  /// once with why it has come to nothing, unless this is closed before; none:
  /// it is secure, and whoever is at the other end is of the site, or has shown
  /// nothing. Nothing else may be done meanwhile.
  /// @param protocol see `tls_engine`.
  void secure(const std::shared_ptr<site_identity>& own, tls_engine::role as,
              link_core::verdict done, const char* protocol = http_protocol) {
    core_->secure(own, as, std::move(done), protocol);
  }

  /// Null: what is said is plain.
  const tls_engine* tls() const {
    return core_->tls.get();
  }

  /// Why the other end has broken off a secure one, as it has said by TLS: it
  /// looks at certificates only after this end has. None: it has not.
  std::optional<distrusted> refusal() const {
    return core_->tls ? core_->tls->problem() : std::nullopt;
  }

  template <class Buffers, class Handler>
  void async_read_some(const Buffers& into, Handler&& handler) {
    if (!core_->tls)
      return core_->bare.async_read_some(into, std::forward<Handler>(handler));
    core_->read(first_of<boost::asio::mutable_buffer>(into),
                shared_action(std::forward<Handler>(handler)));
  }

  template <class Buffers, class Handler>
  void async_write_some(const Buffers& from, Handler&& handler) {
    if (!core_->tls)
      return core_->bare.async_write_some(from, std::forward<Handler>(handler));
    // Several buffers in one record: a frame and its head are one packet.
    std::string bytes(std::min(boost::asio::buffer_size(from), max_write),
                      '\0');
    boost::asio::buffer_copy(boost::asio::buffer(bytes), from);
    core_->write(bytes, shared_action(std::forward<Handler>(handler)));
  }

  /// Says that nothing more comes.
  void shut_sending() {
    core_->shut_sending();
  }

  /// Without waiting for anything. Nothing of one that was moved from.
  void close() {
    if (core_)
      core_->close();
  }

private:
  static constexpr size_t max_write = 64UL * 1024;

  template <class Handler>
  static link_core::action shared_action(Handler&& handler) {
    auto kept =
        std::make_shared<std::decay_t<Handler>>(std::forward<Handler>(handler));
    return [kept](error ec, size_t size) { (*kept)(ec, size); };
  }

  template <class Buffer, class Buffers>
  static Buffer first_of(const Buffers& all) {
    const auto end = boost::asio::buffer_sequence_end(all);
    for (auto i = boost::asio::buffer_sequence_begin(all); i != end; ++i)
      if (Buffer x{*i}; x.size() > 0)
        return x;
    return {};
  }

  std::shared_ptr<link_core> core_;
};

/// As for a bare socket.
inline void close_now(link_socket& socket) {
  socket.close();
}

/// The same under the name by which Beast asks for it.
inline void beast_close_socket(link_socket& socket) {
  socket.close();
}

} // namespace roscell
