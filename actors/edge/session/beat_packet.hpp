#pragma once

#include "actors/edge/io/crypto.hpp"
#include "messages/beat.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace roscell {

/// The 16 bytes of a beat, 58 on an Ethernet wire: session tag (4), kind (4
/// bits, counted from 1) and sequence number (28 bits), truncated HMAC-SHA256
/// of the eight bytes before (8). All numbers are big-endian.
struct beat_packet {
  static constexpr size_t size = 16;

  /// At one packet every 250 ms this lasts two years.
  static constexpr uint32_t max_sequence = (uint32_t{1} << 28) - 1;

  uint32_t tag = 0; ///< The first four bytes of the session id.
  beat_kind kind = beat_kind::beat;
  uint32_t sequence = 0; ///< At most `max_sequence`.
};

using beat_bytes = std::array<char, beat_packet::size>;

/// The tag of a session, whose id is 16 hexadecimal digits.
uint32_t beat_tag(std::string_view session);

beat_bytes encode_beat(const beat_packet& packet, const digest& key);

/// Reads a packet whose MAC is not yet checked, to find its session by the
/// tag. Nothing if the size is not 16 or the kind is unknown.
std::optional<beat_packet> read_beat(std::string_view bytes);

/// Whether the MAC of the packet in `bytes`, which `read_beat` took, was made
/// with `key`. Takes the same time for every MAC.
bool is_authentic_beat(std::string_view bytes, const digest& key);

} // namespace roscell
