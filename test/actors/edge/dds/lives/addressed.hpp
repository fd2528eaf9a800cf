#pragma once

#include "actors/edge/dds/rtps/discovery_probe.hpp"
#include "actors/edge/dds/rtps/rtps_messages.hpp"
#include "dds/server_addresses.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace roscell::test {

/// The RTPS message, for the participant with this prefix alone.
inline std::vector<std::uint8_t> addressed(std::vector<std::uint8_t> message,
                                           const guid_prefix& to) {
  std::vector<std::uint8_t> part{0x0e, 1, 12, 0};
  part.insert(part.end(), to.begin(), to.end());
  message.insert(message.begin() + rtps_header_bytes, part.begin(), part.end());
  return message;
}

/// A participant's word of itself, as server `by` tells it.
inline std::vector<std::uint8_t> passed_on(const guid_prefix& who,
                                           std::uint8_t by) {
  auto result = probe_question(who, {});
  const auto sender = server_prefix(by);
  std::copy(sender.begin(), sender.end(), result.begin() + rtps_sender_at);
  return result;
}

} // namespace roscell::test
