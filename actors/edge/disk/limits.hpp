#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Builds of skills, as they are stored and passed on.
namespace roscell::limits::build {

/// Longest path of a file, and of what a link points to.
constexpr size_t path_bytes = 1024;
/// Longest manifest, and the values in it: those of `folder_limits`' files and
/// of the pieces of its bytes.
constexpr size_t manifest_bytes = 4 * mib;
constexpr size_t manifest_values = 100'000;

} // namespace roscell::limits::build
