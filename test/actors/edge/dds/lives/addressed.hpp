#pragma once

#include "actors/edge/dds/rtps/submessages.hpp"
#include "dds/server_ids.hpp"

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

} // namespace roscell::test
