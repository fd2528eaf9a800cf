#pragma once

#include "actors/edge/limit_units.hpp"

#include <cstddef>

/// Secrets of a node.
namespace roscell::limits::secret {

/// On one node.
constexpr size_t most = 256;
/// Of one value: more than any key or certificate has.
constexpr size_t bytes = 64 * kib;

} // namespace roscell::limits::secret

/// Builds of skills, as they are stored and passed on.
namespace roscell::limits::build {

/// Longest path of a file, and of what a link points to.
constexpr size_t path_bytes = 1024;
/// Longest manifest, and the values in it: those of `folder_limits`' files and
/// of the pieces of its bytes.
constexpr size_t manifest_bytes = 4 * mib;
constexpr size_t manifest_values = 100'000;

} // namespace roscell::limits::build
