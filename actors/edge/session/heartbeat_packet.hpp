#pragma once

#include "actors/edge/io/crypto.hpp"
#include "messages/session.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

namespace roscell {

/// The 16 bytes of a heartbeat, 58 on an Ethernet wire: session tag (4), kind
/// (4 bits, counted from 1) and sequence number (28 bits), truncated
/// HMAC-SHA256 of the eight bytes before (8). All numbers are big-endian.
struct heartbeat_packet {
  static constexpr size_t size = 16;

  /// At one packet every 250 ms this lasts two years.
  static constexpr uint32_t max_sequence = (uint32_t{1} << 28) - 1;

  uint32_t tag = 0; ///< The first four bytes of the session id.
  heartbeat_kind kind = heartbeat_kind::heartbeat;
  uint32_t sequence = 0; ///< At most `max_sequence`.
};

using heartbeat_bytes = std::array<char, heartbeat_packet::size>;

/// The tag of a session, whose id is 16 hexadecimal digits.
uint32_t heartbeat_tag(std::string_view session);

heartbeat_bytes encode_heartbeat(const heartbeat_packet& packet,
                                 const digest& key);

/// Reads a packet whose MAC is not yet checked, to find its session by the
/// tag. Nothing if the size is not 16 or the kind is unknown.
std::optional<heartbeat_packet> read_heartbeat(std::string_view bytes);

/// Whether the MAC of the packet in `bytes`, which `read_heartbeat` took, was
/// made with `key`. Takes the same time for every MAC.
bool is_authentic_heartbeat(std::string_view bytes, const digest& key);

} // namespace roscell
