#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/handshake.hpp"

#include <cstdint>
#include <string>
#include <string_view>

/// The JSON codec of the four frames with which a session begins. They come
/// from unauthenticated peers: decoding checks every field, and an unknown
/// field is ignored.
namespace roscell {

/// Protocol version of sessions. A peer with another major version is
/// refused by name; a minor version adds optional fields only.
inline constexpr std::string_view session_version = "2.0";

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
