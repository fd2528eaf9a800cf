#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Names and numbers that unauthenticated peers send. The schemas say the same.
namespace roscell::limits {

namespace membership {

/// Names that are being looked up at a time: each has a thread, which a dead
/// name server holds for long.
constexpr size_t lookups = 8;

} // namespace membership

namespace text {

constexpr size_t name_bytes = 63;
constexpr size_t uuid_bytes = 64;

} // namespace text

} // namespace roscell::limits
