#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace roscell {

/// What a UDP packet between two nodes of a session says.
enum class heartbeat_kind : uint8_t {
  heartbeat, ///< I am here; wants an ack.
  ack,       ///< I have got a heartbeat.
  probe,     ///< Are you there? Wants a heartbeat at once.
};

constexpr auto enum_words(heartbeat_kind) {
  return std::array<std::string_view, 3>{"beat", "ack", "probe"};
}

} // namespace roscell
