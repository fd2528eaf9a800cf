#include "actors/edge/dds/rtps/discovery_filter.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace roscell {

namespace {

/// Submessage kinds of RTPS 2.3, 9.4.5.1.1, and one of Fast DDS.
enum submessage : std::uint8_t {
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
constexpr std::uint8_t flag_little_endian = 1;
constexpr std::uint8_t flag_inline_qos = 2;
constexpr std::uint8_t flag_no_timestamp = 2;
constexpr std::uint8_t flag_data = 4;
constexpr std::uint8_t flag_key = 8;

constexpr std::size_t statistics_bytes = 56;
constexpr std::uint32_t max_set_bits = 256;

/// A discovery writer never skips more; Fast DDS walks over every number.
constexpr std::int64_t max_gap = 1 << 16;

/// What the writers of participant, publication and subscription data write
/// about; none for any other writer.
std::optional<described_entity> subject_of(std::uint32_t big_endian_entity) {
  switch (big_endian_entity) {
  case 0x000100c2:
    return described_entity::participant;
  case 0x000003c2:
    return described_entity::writer;
  case 0x000004c2:
    return described_entity::reader;
  default:
    return std::nullopt;
  }
}

/// A sequence number set: its base and as many bits as it says.
bool skip_number_set(wire_cursor& in, std::int64_t& base) {
  base = in.sequence_number();
  auto bits = in.u32();
  if (bits > max_set_bits)
    return false;
  return in.skip(4 * std::size_t{(bits + 31) / 32});
}

bool is_acknack(wire_cursor in) {
  std::int64_t base = 0;
  return in.skip(8) && skip_number_set(in, base) && base >= 0 && in.skip(4)
         && in.at_end();
}

bool is_heartbeat(wire_cursor in) {
  in.skip(8);
  auto first = in.sequence_number();
  auto last = in.sequence_number();
  return in.skip(4) && first > 0 && last >= first - 1;
}

bool is_gap(wire_cursor in) {
  in.skip(8);
  auto first = in.sequence_number();
  std::int64_t base = 0;
  return skip_number_set(in, base) && in.at_end() && first > 0 && base >= first
         && base - first <= max_gap;
}

constexpr std::uint32_t liveliness_writer = 0x000200c2;

/// A program says that its writers are alive: whose, of which kind, and bytes
/// without a meaning (RTPS 2.3, 9.6.2.1). Fast DDS reads the first twenty of
/// them, its encapsulation included, without looking.
bool is_liveliness(wire_cursor in, std::uint8_t flags) {
  constexpr std::size_t least_bytes = 24;
  constexpr std::size_t most_bytes = 512;
  return (flags & (flag_inline_qos | flag_key)) == 0 && (flags & flag_data) != 0
         && in.size() >= least_bytes && in.size() <= most_bytes;
}

/// Reader, writer and sequence number first, then perhaps the inline QoS and
/// perhaps the payload, each a parameter list.
bool make_data_safe(wire_cursor in, std::uint8_t flags, arrival how) {
  in.skip(2);
  auto octets_to_qos = in.u16();
  in.skip(4);
  auto writer = in.big_endian_u32();
  auto subject = subject_of(writer);
  auto number = in.sequence_number();
  if (writer == liveliness_writer)
    return in.good() && octets_to_qos == 16 && number > 0
           && is_liveliness(in, flags);
  if (!in.good() || octets_to_qos != 16 || number <= 0 || !subject
      || (flags & flag_key) != 0)
    return false;
  parameter_guard guard{*subject, how};
  if ((flags & flag_inline_qos) != 0 && !guard.make_safe(in))
    return false;
  if ((flags & flag_data) == 0)
    return in.at_end() && guard.has_key();
  // The payload says its own byte order: PL_CDR_BE or PL_CDR_LE.
  auto encapsulation = in.big_endian_u32() >> 16;
  if (encapsulation != 2 && encapsulation != 3)
    return false;
  in.little_endian(encapsulation == 3);
  return guard.make_safe(in) && in.at_end() && guard.has_key();
}

bool make_submessage_safe(std::uint8_t kind, std::uint8_t flags,
                          wire_cursor body, bool last, arrival how) {
  switch (kind) {
  case pad:
    return true;
  case acknack:
    return is_acknack(body);
  case heartbeat:
    return is_heartbeat(body);
  case gap:
    return is_gap(body);
  case info_ts:
    return body.size() == ((flags & flag_no_timestamp) != 0 ? 0U : 8U);
  case info_dst:
    return body.size() == 12;
  case data:
    return make_data_safe(body, flags, how);
  case fast_dds_statistics:
    return last && body.size() == statistics_bytes;
  default:
    return false;
  }
}

} // namespace

bool make_safe(std::uint8_t* datagram, std::size_t size, arrival how) {
  constexpr std::size_t header_bytes = 20;
  constexpr std::array<std::uint8_t, 5> magic{'R', 'T', 'P', 'S', 2};
  if (size <= header_bytes || !std::equal(magic.begin(), magic.end(), datagram))
    return false;
  wire_cursor in{datagram + header_bytes, size - header_bytes};
  while (!in.at_end()) {
    auto kind = in.u8();
    auto flags = in.u8();
    in.little_endian((flags & flag_little_endian) != 0);
    auto length = in.u16();
    // Length 0 means "the rest" but in these two, which nobody needs.
    if (length == 0 && kind != pad && kind != info_ts)
      return false;
    auto body = in.take(length);
    if (!in.good() || length % 4 != 0
        || !make_submessage_safe(kind, flags, body, in.at_end(), how))
      return false;
  }
  return true;
}

} // namespace roscell
