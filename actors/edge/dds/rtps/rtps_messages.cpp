#include "actors/edge/dds/rtps/rtps_messages.hpp"

#include <algorithm>

namespace roscell {

void put_word(wire_cursor at, std::uint32_t value) {
  for (unsigned i = 0; i < 4; ++i) {
    const auto shift = 8 * (at.is_little_endian() ? i : 3 - i);
    at.position()[i] = static_cast<std::uint8_t>(value >> shift);
  }
}

void put_number(wire_cursor at, std::int64_t value) {
  const auto bits = static_cast<std::uint64_t>(value);
  put_word(at, static_cast<std::uint32_t>(bits >> 32));
  at.skip(4);
  put_word(at, static_cast<std::uint32_t>(bits));
}

std::int64_t raise_number(wire_cursor& at, std::int64_t by) {
  const auto place = at;
  const auto raised = at.sequence_number() + by;
  if (at.good())
    put_number(place, raised);
  return raised;
}

void raise_identity(wire_cursor qos, const guid_prefix& author,
                    std::int64_t by) {
  constexpr std::size_t guid_bytes = 16;
  constexpr std::size_t number_bytes = 8;
  while (qos.good()) {
    const auto id = qos.u16();
    auto value = qos.take(qos.u16());
    if (!value.good() || id == parameter_id::sentinel)
      return;
    if (id != parameter_id::related_sample_identity
        || value.size() < guid_bytes + number_bytes
        || !std::equal(author.begin(), author.end(), value.position()))
      continue;
    value.skip(guid_bytes);
    raise_number(value, by);
  }
}

} // namespace roscell
