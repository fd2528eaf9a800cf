#pragma once

#include "actors/edge/trust/chain_check.hpp"
#include "actors/edge/trust/identity_file.hpp"

#include <openssl/ssl.h>

#include <functional>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace roscell {

/// Whom to believe, as it is at the moment of a handshake.
struct trust_now {
  site_trust site;
  int64_t unix_s = 0; ///< See `trusted_now`.
};

/// What all connections of one who has an identity have in common: TLS 1.3, his
/// certificate, and the check of whoever is at the other end. Copies share it.
/// From any thread.
class tls_settings {
public:
  /// @param trust asked at each handshake, by the thread that does it.
  tls_settings(const own_identity& own, std::function<trust_now()> trust);

  /// For one who has no identity yet, and so believes nobody at first: who is
  /// at the other end is looked at afterwards, by `tls_engine::peer_chain`.
  static tls_settings of_newcomer();

  SSL_CTX* get() const noexcept {
    return context_.get();
  }

private:
  tls_settings();

  std::shared_ptr<SSL_CTX> context_;
};

/// Protocols that are spoken inside, as ALPN names them.
constexpr const char* session_protocol = "roscell/1";
constexpr const char* http_protocol = "http/1.1";
/// HTTP of those who come for an identity: with none, or with one that has
/// ended.
constexpr const char* entry_protocol = "roscell-entry/1";

/// What a handshake has found out of the other end, kept with the connection
/// that it is of. INTERNAL to this folder.
struct handshake_finding {
  std::variant<std::monostate, identity, distrusted> who;
};

/// The finding of a connection. INTERNAL to this folder.
handshake_finding& finding_of(const SSL* connection);

} // namespace roscell
