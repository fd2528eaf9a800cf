#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>
#include <cstdint>

/// Limits of what the edge reads from outside and of the host.
namespace roscell::limits {

// Names and numbers that unauthenticated peers send. The schemas say the same.

namespace membership {

/// Names that are being looked up at a time: each has a thread, which a dead
/// name server holds for long.
constexpr size_t lookups = 8;

} // namespace membership

namespace text {

constexpr size_t name_bytes = 63;
constexpr size_t uuid_bytes = 64;

} // namespace text

// Reading what a host has and uses.

namespace resource {

/// CPU use is a rate over at least the first and at most the second.
constexpr seconds least_sample_age{1};
constexpr seconds most_sample_age{30};
/// Samples closer than this are one; so that many always span more than
/// `least_sample_age`.
constexpr milliseconds sample_distance{100};
constexpr size_t samples = 16;

} // namespace resource

// What programs print, and say of themselves.

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

// Folders that are watched.

namespace folder {

/// Who writes without end wakes the io thread this often at most.
constexpr milliseconds change_pause{50};
/// Folders in one watch. The kernel keeps some 1 KiB for each, and gives a user
/// 8192 and more.
constexpr size_t watched = 4096;

} // namespace folder

} // namespace roscell::limits
