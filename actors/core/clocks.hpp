#pragma once

#include "actors/edge/io/node_time.hpp"

#include <cstdint>
#include <ctime>

namespace caf {
class actor_system;
}

namespace roscell {

/// Milliseconds since this host was booted, those in which it slept too: the
/// clock that a node shares with the shims that outlive it. The same for every
/// actor system of the host.
inline int64_t boot_now_ms(caf::actor_system&) {
  timespec now{};
  ::clock_gettime(CLOCK_BOOTTIME, &now);
  return static_cast<int64_t>(now.tv_sec) * 1000 + now.tv_nsec / 1'000'000;
}

/// Milliseconds since 1970, for people to read. No decision depends on it:
/// clocks of different nodes may differ by years. It is the time of this node,
/// which is told as the wall clock has it (shifted_times.hpp).
inline int64_t unix_now_ms() {
  return node_time_ms();
}

} // namespace roscell
