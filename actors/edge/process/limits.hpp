#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>
#include <cstdint>

/// What programs print, and say of themselves.
namespace roscell::limits {

namespace instance {

/// A program that talks to its NOTIFY_SOCKET without end causes 50 messages a
/// second at most: what comes in between is merged, or waits in its socket.
constexpr milliseconds status_pause{20};

} // namespace instance

namespace log {

/// A program that prints without end wakes the io thread this often at most.
constexpr milliseconds change_pause{20};
/// Who follow one log at a time. Who comes later is answered at once.
constexpr size_t followers = 64;
/// Most bytes in one part of a log.
constexpr int64_t part_bytes = 64 * kib;

} // namespace log

} // namespace roscell::limits
