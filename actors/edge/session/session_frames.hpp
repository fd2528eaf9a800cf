#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/codec/described.hpp"

#include <cstdint>
#include <string>
#include <string_view>

/// The four frames with which a session begins, in the order in which they
/// are sent, and their JSON codec. They come from unauthenticated peers:
/// decoding checks every field, and an unknown field is ignored.
namespace roscell {

/// Protocol version of sessions. A peer with another major version is
/// refused by name; a minor version adds optional fields only.
inline constexpr std::string_view session_version = "2.0";

/// The role of a joiner that coordinates another cell.
inline constexpr std::string_view coordinator_role = "coordinator";

/// Upper bounds of what an unauthenticated peer may send, in bytes.
struct session_frame_bounds {
  static constexpr size_t frame = 4096;
  static constexpr size_t version = 16;
  static constexpr size_t nonce = 64;   ///< Hexadecimal digits, exactly.
  static constexpr size_t proof = 64;   ///< Hexadecimal digits, exactly.
  static constexpr size_t session = 16; ///< Hexadecimal digits, exactly.
  /// The largest integer that every JSON implementation keeps exactly.
  static constexpr int64_t number = (int64_t{1} << 53) - 1;
};

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

  static constexpr auto fields() {
    return field_list{required("session", &session_accepted::session)};
  }
};

std::string encode(const session_hello& frame);
std::string encode(const session_challenge& frame);
std::string encode(const session_proof& frame);
std::string encode(const session_accepted& frame);

/// A refusal in the form of every error of ROSCell, as a frame.
std::string encode(const edge_error& refusal);

/// The frame of type `Frame` in `text`. Where `text` is a peer's error frame,
/// that error; where it is anything else, `malformed_json` or
/// `schema_violation`. Instantiated for the four frames above.
template <class Frame>
edge_result<Frame> decode_frame(std::string_view text);

} // namespace roscell
