#pragma once

#include "actors/edge/dds/rtps/discovery_probe.hpp"

#include <cstdint>
#include <functional>
#include <string>

namespace roscell {

/// One thing that a participant of ours noticed about another participant.
struct sighting {
  enum class kind {
    appeared, ///< It was found.
    changed,  ///< Its announcement changed.
    left,     ///< It said that it goes.
    lost,     ///< It was silent for its lease.
  };

  kind what = kind::appeared;
  guid_prefix prefix{};
  std::string name;         ///< The participant's name, at most 255 bytes.
  std::string announcement; ///< Its USER_DATA, empty if over the limit.
};

/// What a discovery server says of itself to who asks.
struct server_sighting {
  std::uint8_t server_id = 0;
  guid_prefix prefix{};
  std::string announcement; ///< USER_DATA as it came, foreign bytes included.
};

/// Called on a thread of Fast DDS, one call at a time for one participant.
using on_sighting = std::function<void(const sighting&)>;

} // namespace roscell
