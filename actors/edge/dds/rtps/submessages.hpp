#pragma once

#include "actors/edge/dds/rtps/discovery_wire.hpp"

#include <cstddef>
#include <cstdint>

/// INTERNAL to this folder and those of actors/edge/dds: the parts of an RTPS
/// message (RTPS 2.3, 8.3.3 and 9.4.5).
namespace roscell {

/// Those that discovery uses, and one of Fast DDS.
enum class submessage_kind : std::uint8_t {
  pad = 0x01,
  acknack = 0x06,
  heartbeat = 0x07,
  gap = 0x08,
  info_ts = 0x09,
  info_dst = 0x0e,
  data = 0x15,
  fast_dds_statistics = 0x80,
};

/// Flags of DATA (9.4.5.3), and the one of INFO_TS that it shares a bit with.
namespace submessage_flag {
constexpr std::uint8_t little_endian = 1;
constexpr std::uint8_t inline_qos = 2;
constexpr std::uint8_t no_timestamp = 2;
constexpr std::uint8_t data = 4;
constexpr std::uint8_t key = 8;
} // namespace submessage_flag

/// The writers of what discovery tells (9.3.1.5).
namespace discovery_writer {
constexpr std::uint32_t participants = 0x000100c2;
constexpr std::uint32_t publications = 0x000003c2;
constexpr std::uint32_t subscriptions = 0x000004c2;
} // namespace discovery_writer

/// Of the protocol, its version, the vendor and the sender's prefix.
constexpr std::size_t rtps_header_bytes = 20;
constexpr std::size_t rtps_sender_at = 8;

struct submessage_view {
  submessage_kind kind;
  std::uint8_t flags;
  wire_cursor body; ///< In the submessage's byte order.
  bool last;        ///< Nothing follows.
};

/// `visit` gets each submessage of a message whose header has been looked at,
/// until it returns false or one is not whole; false: one of the two. A length
/// of 0 means "the rest" but in those that may be empty, which nobody needs:
/// not whole.
template <class Visit>
bool for_each_submessage(std::uint8_t* message, std::size_t size, Visit visit) {
  if (size < rtps_header_bytes)
    return false;
  wire_cursor in{message + rtps_header_bytes, size - rtps_header_bytes};
  while (!in.at_end()) {
    const auto kind = static_cast<submessage_kind>(in.u8());
    const auto flags = in.u8();
    in.little_endian((flags & submessage_flag::little_endian) != 0);
    const auto length = in.u16();
    if (length == 0 && kind != submessage_kind::pad
        && kind != submessage_kind::info_ts)
      return false;
    const auto body = in.take(length);
    if (!in.good())
      return false;
    if (!visit(submessage_view{kind, flags, body, in.at_end()}))
      return false;
  }
  return true;
}

} // namespace roscell
