#pragma once

#include <chrono>
#include <cstdint>

namespace roscell {

/// Milliseconds since 1970, for people to read. No decision depends on it:
/// clocks of different nodes may differ by years.
inline int64_t unix_now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch())
      .count();
}

} // namespace roscell
