#pragma once

#include "actors/edge/trust/tls_settings.hpp"

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

/// One end of a connection by TLS, without the connection: whoever owns it
/// brings the bytes. So the costly part, the handshake, is done by a thread of
/// its own choice. Of one thread at a time.
///
///     shaking hands -- both have proved who they are --> open
///     shaking hands, open -- what comes breaks the rules,
///                            or is more than a handshake may be --> failed
///     open -- the other end says that no more comes --> ended
class tls_engine {
public:
  enum class role { accepts, connects };

  /// Of what a handshake sends nothing may be longer than this in all.
  static constexpr size_t max_handshake_bytes = 32UL * 1024;

  /// @param protocol what is spoken inside, for one who connects.
  tls_engine(const tls_settings& settings, role as,
             const char* protocol = http_protocol);

  /// Takes bytes as they have come from the other end.
  void take(std::string_view bytes);

  /// The bytes that are to be sent to the other end; empty: none.
  std::string give();

  bool is_open() const noexcept {
    return open_;
  }

  /// The other end has said that nothing more comes.
  bool has_ended() const noexcept {
    return ended_;
  }

  /// Why it has come to nothing; none: it has not. What `give` gives then tells
  /// the other end, too.
  const std::optional<distrusted>& problem() const noexcept {
    return problem_;
  }

  /// Who is at the other end of an open one; none: he has shown no certificate,
  /// or this end believes nobody yet.
  std::optional<identity> peer() const;

  /// What he has shown, his own first, believed or not.
  std::vector<certificate> peer_chain() const;

  /// What is spoken inside; empty: the other end has not said it.
  std::string protocol() const;

  /// Once it is open: what has come, at most so many bytes; empty: nothing yet.
  std::string read(size_t most);

  /// Once it is open: takes bytes to be sent.
  void write(std::string_view bytes);

  /// Says that nothing more comes.
  void close();

  /// Keying material of this connection alone, the same at both its ends
  /// (RFC 8446, 7.5): 32 bytes. Throws std::runtime_error before it is open.
  std::string exported(std::string_view label) const;

private:
  void shake_hands();
  void fail();
  void fail(distrusted why);

  std::unique_ptr<SSL, released_by<SSL_free>> ssl_;
  BIO* incoming_ = nullptr; ///< Both are the connection's.
  BIO* outgoing_ = nullptr;
  size_t taken_ = 0; ///< During the handshake.
  bool open_ = false;
  bool ended_ = false;
  std::optional<distrusted> problem_;
};

} // namespace roscell
