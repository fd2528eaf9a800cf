#pragma once

#include "actors/edge/dds/rtps/discovery_wire.hpp"
#include "dds/server_addresses.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <vector>

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

// INTERNAL to actors/edge/dds: writing numbers into an RTPS message that is
// sound.

void put_word(wire_cursor at, std::uint32_t value);

void put_number(wire_cursor at, std::int64_t value);

/// Raises the sequence number there, and returns it. Leaves `at` behind it.
std::int64_t raise_number(wire_cursor& at, std::int64_t by);

/// Raises the number of a sample's identity in the inline QoS there, where the
/// sample is of `author`. The identity goes with the sample wherever it is
/// passed on, and of two samples the one with the higher number counts.
void raise_identity(wire_cursor qos, const guid_prefix& author,
                    std::int64_t by);

// INTERNAL to this folder: writing RTPS messages from nothing.

using message_bytes = std::vector<std::uint8_t>;

/// Of what tells of participants.
constexpr std::array<std::uint8_t, 4> pdp_writer_entity{0, 1, 0, 0xc2};
constexpr std::array<std::uint8_t, 4> pdp_reader_entity{0, 1, 0, 0xc7};

/// "RTPS", protocol 2.3, vendor eProsima: servers of Fast DDS take no other.
constexpr std::array<std::uint8_t, 8> rtps_header{'R', 'T', 'P', 'S',
                                                  2,   3,   1,   0x0f};

template <class Range>
void put_all(message_bytes& to, const Range& range) {
  to.insert(to.end(), std::begin(range), std::end(range));
}

/// Everything here is little-endian, as the submessage's flag E says.
template <class T>
void put(message_bytes& to, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    to.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
}

inline void put_sequence_number(message_bytes& to, std::uint32_t number) {
  put(to, std::uint32_t{0}); // The high half comes first.
  put(to, number);
}

} // namespace roscell

/// Parameter ids of RTPS 2.3, 9.6.2.2.2, DDS-XTypes 1.2, DDS Security 1.1 and
/// Fast DDS that we write or look at.
namespace roscell::parameter_id {

enum value : std::uint16_t {
  padding = 0x0000,
  sentinel = 0x0001,
  lease_duration = 0x0002,
  topic_name = 0x0005,
  type_name = 0x0007,
  protocol_version = 0x0015,
  vendor_id = 0x0016,
  partition = 0x0029,
  user_data = 0x002c,
  group_data = 0x002d,
  topic_data = 0x002e,
  metatraffic_unicast_locator = 0x0032,
  content_filter = 0x0035,
  participant_guid = 0x0050,
  builtin_endpoint_set = 0x0058,
  property_list = 0x0059,
  endpoint_guid = 0x005a,
  entity_name = 0x0062,
  type_id = 0x0069,
  key_hash = 0x0070,
  status_info = 0x0071,
  type_object = 0x0072,
  data_representation = 0x0073,
  type_information = 0x0075,
  related_sample_identity = 0x800f,
  identity_token = 0x1001,
  permissions_token = 0x1002,
  data_tags = 0x1003,
  identity_status_token = 0x1006,
  data_sharing = 0x8006,
};

} // namespace roscell::parameter_id
