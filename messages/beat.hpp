#pragma once

#include <array>
#include <cstdint>
#include <string_view>

namespace roscell {

/// What a UDP packet between two nodes of a session says.
enum class beat_kind : uint8_t {
  beat,  ///< I am here; wants an ack.
  ack,   ///< I have got a beat.
  probe, ///< Are you there? Wants a beat at once.
};

constexpr auto enum_words(beat_kind) {
  return std::array<std::string_view, 3>{"beat", "ack", "probe"};
}

} // namespace roscell
