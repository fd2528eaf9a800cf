#pragma once

#include "actors/edge/io/node_time.hpp"

#include <cstdint>

namespace roscell {

/// Milliseconds since 1970, for people to read. No decision depends on it:
/// clocks of different nodes may differ by years. It is the time of this node,
/// which is told as the wall clock has it (shifted_times.hpp).
inline int64_t unix_now_ms() {
  return node_time_ms();
}

} // namespace roscell
