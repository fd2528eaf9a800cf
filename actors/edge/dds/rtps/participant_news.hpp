#pragma once

#include "dds/server_ids.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

/// INTERNAL to actors/edge/dds.
namespace roscell {

struct participant_news {
  guid_prefix who{};
  bool ended = false; ///< It is told that it is not there any more.
};

/// The sender of an RTPS message.
guid_prefix sender_of(const std::uint8_t* message);

/// The participants whom a message that is safe (discovery_filter.hpp) tells
/// of.
std::vector<participant_news> participants_in(std::uint8_t* message,
                                              std::size_t size);

} // namespace roscell
