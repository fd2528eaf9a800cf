#include "actors/edge/dds/rtps/heartbeats.hpp"

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/message_bytes.hpp"
#include "actors/edge/dds/rtps/submessages.hpp"

#include <algorithm>
#include <limits>

namespace roscell {

std::vector<std::uint8_t> heartbeat_answer(const guid_prefix& self,
                                           std::uint32_t count,
                                           std::uint8_t* datagram,
                                           std::size_t size) {
  constexpr std::int64_t most_bits = 32;
  bool is_for_self = false;
  std::int64_t first = 0;
  std::int64_t last = 0;
  for_each_submessage(datagram, size, [&](const submessage_view& x) {
    auto in = x.body;
    if (x.kind == submessage_kind::info_dst && in.size() >= self.size())
      is_for_self = std::equal(self.begin(), self.end(), in.position());
    if (!is_for_self || x.kind != submessage_kind::heartbeat || !in.skip(4)
        || in.big_endian_u32() != discovery_writer::participants)
      return true;
    first = in.sequence_number();
    last = in.sequence_number();
    return !in.good() || first > last; // There is nothing.
  });
  const auto server = probe_answer(datagram, size);
  if (!server || first < 1 || first > last
      || first > std::numeric_limits<std::uint32_t>::max())
    return {};
  message_bytes result(rtps_header.begin(), rtps_header.end());
  put_all(result, self);
  put_all(result, message_bytes{0x0e, 1, 12, 0}); // INFO_DST
  put_all(result, *server);
  put_all(result, message_bytes{0x06, 1, 28, 0}); // ACKNACK
  put_all(result, pdp_reader_entity);
  put_all(result, pdp_writer_entity);
  put_sequence_number(result, static_cast<std::uint32_t>(first));
  const auto bits = std::min(last - first + 1, most_bits);
  put(result, static_cast<std::uint32_t>(bits));
  put(result, ~std::uint32_t{0} << (most_bits - bits));
  put(result, count);
  return result;
}

std::vector<std::uint8_t> first_heartbeats(const guid_prefix& server) {
  constexpr std::uint8_t heartbeat = 0x07;
  constexpr std::uint8_t flags = 1 | 2; // Little-endian, no answer is wanted.
  constexpr std::uint16_t body_bytes = 28;
  // Of participants, publications, subscriptions and liveliness.
  constexpr std::array<std::array<std::uint8_t, 3>, 4> entities{
      {{0, 1, 0}, {0, 0, 3}, {0, 0, 4}, {0, 2, 0}}};
  message_bytes result(rtps_header.begin(), rtps_header.end());
  put_all(result, server);
  for (const auto& entity : entities) {
    result.push_back(heartbeat);
    result.push_back(flags);
    put(result, body_bytes);
    put_all(result, entity);
    result.push_back(0xc7); // A reader,
    put_all(result, entity);
    result.push_back(0xc2);         // and a writer, with a key.
    put_sequence_number(result, 1); // The first that there is,
    put_sequence_number(result, 0); // and the last.
    put(result, std::uint32_t{1});  // Of its HEARTBEATs.
  }
  return result;
}

} // namespace roscell
