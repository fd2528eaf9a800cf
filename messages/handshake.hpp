#pragma once

#include "messages/codec/described.hpp"

#include <cstdint>
#include <string>
#include <string_view>

/// The four frames with which a session begins, in the order in which they are
/// sent. What is proved with them is in
/// actors/edge/session/session_handshake.hpp.
namespace roscell {

/// The role of a joiner that coordinates another cell.
inline constexpr std::string_view coordinator_role = "coordinator";

/// Joiner to acceptor: who I am, and a fresh nonce.
struct session_hello {
  static constexpr const char* type = "session_hello";

  std::string version; ///< "major.minor".
  std::string node;    ///< The joiner's name.
  std::string uuid;    ///< The joiner's UUID.
  int64_t epoch = 0;   ///< The joiner's registration epoch.
  std::string nonce;   ///< 32 random bytes, hexadecimal.
  /// `coordinator_role`, then `epoch` is its incarnation; empty for one that
  /// wants to be a member.
  std::string role{};

  static constexpr auto fields() {
    return field_list{required("version", &session_hello::version),
                      required("node", &session_hello::node),
                      required("uuid", &session_hello::uuid),
                      required("epoch", &session_hello::epoch),
                      required("nonce", &session_hello::nonce),
                      optional("role", &session_hello::role)};
  }
};

/// Acceptor to joiner: who I am, a fresh nonce, and proof of the site token.
struct session_challenge {
  static constexpr const char* type = "session_challenge";

  std::string version;     ///< "major.minor".
  std::string node;        ///< The acceptor's name.
  std::string uuid;        ///< The acceptor's UUID.
  std::string cell;        ///< The cell that it coordinates.
  int64_t incarnation = 0; ///< How often this coordinator was started.
  std::string nonce;       ///< 32 random bytes, hexadecimal.
  std::string proof;       ///< HMAC-SHA256, hexadecimal.

  static constexpr auto fields() {
    return field_list{required("version", &session_challenge::version),
                      required("node", &session_challenge::node),
                      required("uuid", &session_challenge::uuid),
                      required("cell", &session_challenge::cell),
                      required("incarnation", &session_challenge::incarnation),
                      required("nonce", &session_challenge::nonce),
                      required("proof", &session_challenge::proof)};
  }
};

/// Joiner to acceptor: proof of the site token.
struct session_proof {
  static constexpr const char* type = "session_proof";

  std::string proof; ///< HMAC-SHA256, hexadecimal.

  static constexpr auto fields() {
    return field_list{required("proof", &session_proof::proof)};
  }
};

/// Acceptor to joiner: from here on the session carries other frames.
struct session_accepted {
  static constexpr const char* type = "session_accepted";

  std::string session; ///< Both sides compute it, hexadecimal.
  /// Number of the acceptor's list of the revoked; 0: it has none.
  int64_t revocations = 0;

  static constexpr auto fields() {
    return field_list{required("session", &session_accepted::session),
                      optional("revocations", &session_accepted::revocations)};
  }
};

} // namespace roscell
