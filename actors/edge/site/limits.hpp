#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Secrets.
namespace roscell::limits {

namespace token {

/// A site token shorter than this could be guessed.
constexpr size_t least_site_bytes = 16;
constexpr size_t most_bytes = 4 * kib;

} // namespace token

} // namespace roscell::limits
