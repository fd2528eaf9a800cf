#include "actors/edge/dds/rtps/discovery_wire.hpp"

#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <algorithm>
#include <array>
#include <optional>

namespace roscell {

namespace {

namespace flag = submessage_flag;

constexpr std::size_t statistics_bytes = 56;
constexpr std::uint32_t max_set_bits = 256;

/// A discovery writer never skips more; Fast DDS walks over every number.
constexpr std::int64_t max_gap = 1 << 16;

/// What the writers of participant, publication and subscription data write
/// about; none for any other writer.
std::optional<described_entity> subject_of(std::uint32_t big_endian_entity) {
  switch (big_endian_entity) {
  case discovery_writer::participants:
    return described_entity::participant;
  case discovery_writer::publications:
    return described_entity::writer;
  case discovery_writer::subscriptions:
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
  return (flags & (flag::inline_qos | flag::key)) == 0
         && (flags & flag::data) != 0 && in.size() >= least_bytes
         && in.size() <= most_bytes;
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
      || (flags & flag::key) != 0)
    return false;
  parameter_guard guard{*subject, how};
  if ((flags & flag::inline_qos) != 0 && !guard.make_safe(in))
    return false;
  if ((flags & flag::data) == 0)
    return in.at_end() && guard.has_key();
  // The payload says its own byte order: PL_CDR_BE or PL_CDR_LE.
  auto encapsulation = in.big_endian_u32() >> 16;
  if (encapsulation != 2 && encapsulation != 3)
    return false;
  in.little_endian(encapsulation == 3);
  return guard.make_safe(in) && in.at_end() && guard.has_key();
}

bool make_submessage_safe(const submessage_view& x, arrival how) {
  const auto& body = x.body;
  switch (x.kind) {
  case submessage_kind::pad:
    return true;
  case submessage_kind::acknack:
    return is_acknack(body);
  case submessage_kind::heartbeat:
    return is_heartbeat(body);
  case submessage_kind::gap:
    return is_gap(body);
  case submessage_kind::info_ts:
    return body.size() == ((x.flags & flag::no_timestamp) != 0 ? 0U : 8U);
  case submessage_kind::info_dst:
    return body.size() == 12;
  case submessage_kind::data:
    return make_data_safe(body, x.flags, how);
  case submessage_kind::fast_dds_statistics:
    return x.last && body.size() == statistics_bytes;
  default:
    return false;
  }
}

} // namespace

bool make_safe(std::uint8_t* datagram, std::size_t size, arrival how) {
  constexpr std::array<std::uint8_t, 5> magic{'R', 'T', 'P', 'S', 2};
  if (size <= rtps_header_bytes
      || !std::equal(magic.begin(), magic.end(), datagram))
    return false;
  return for_each_submessage(datagram, size, [how](const submessage_view& x) {
    return x.body.size() % 4 == 0 && make_submessage_safe(x, how);
  });
}

} // namespace roscell
