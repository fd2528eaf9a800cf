#include "actors/edge/dds/rtps/own_words.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/parameter_ids.hpp"
#include "actors/edge/dds/rtps/submessages.hpp"

#include <algorithm>

namespace roscell {

namespace {

/// A CDR string or sequence of bytes: its length, then as many.
std::string counted_bytes(wire_cursor in) {
  const auto bytes = in.take(in.u32());
  return {bytes.position(), bytes.position() + bytes.size()};
}

/// Leaves `in` behind a parameter list; false: it has no end.
bool skip_list(wire_cursor& in) {
  while (in.good()) {
    const auto id = in.u16();
    in.skip(in.u16());
    if (id == parameter_id::sentinel)
      return in.good();
  }
  return false;
}

/// Leaves `in` at the payload of a DATA of participants; false: it is none.
bool enter_payload(const submessage_view& x, wire_cursor& in) {
  constexpr std::uint16_t bytes_to_inline_qos = 16;
  in.skip(2);
  const auto distance = in.u16();
  in.skip(4);
  const auto writer = in.big_endian_u32();
  in.sequence_number();
  if (x.kind != submessage_kind::data || distance != bytes_to_inline_qos
      || writer != discovery_writer::participants
      || (x.flags & submessage_flag::data) == 0)
    return false;
  if ((x.flags & submessage_flag::inline_qos) != 0 && !skip_list(in))
    return false;
  in.little_endian(in.big_endian_u32() >> 16 == 3); // PL_CDR_LE
  return in.good();
}

/// Of `who`; none: they are another one's.
std::optional<own_words> words_of(const guid_prefix& who, wire_cursor in) {
  own_words result;
  bool is_own = false;
  while (in.good()) {
    const auto id = in.u16();
    const auto value = in.take(in.u16());
    if (!in.good() || id == parameter_id::sentinel)
      break;
    if (id == parameter_id::participant_guid)
      is_own = value.size() >= who.size()
               && std::equal(who.begin(), who.end(), value.position());
    else if (id == parameter_id::user_data)
      result.announcement = counted_bytes(value);
    else if (id == parameter_id::entity_name)
      result.name = counted_bytes(value);
  }
  result.name.erase(std::find(result.name.begin(), result.name.end(), '\0'),
                    result.name.end());
  return in.good() && is_own ? std::optional{result} : std::nullopt;
}

} // namespace

std::optional<own_words> own_words_in(std::uint8_t* message, std::size_t size) {
  const auto sender = probe_answer(message, size);
  std::optional<own_words> result;
  if (sender)
    for_each_submessage(message, size, [&](const submessage_view& x) {
      auto in = x.body;
      if (enter_payload(x, in))
        result = words_of(*sender, in);
      return !result;
    });
  return result;
}

} // namespace roscell
