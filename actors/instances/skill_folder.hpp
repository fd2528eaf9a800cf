#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/inside/runtime.hpp"

/// A skill folder can be edited at any time, and what is in it then is another
/// build than the one that was chosen.
namespace roscell {

/// Whether the folder still holds the build that `request` names. Reads its
/// files only where it looks different than when it was hashed. Blocks on the
/// disk.
///
/// Errors: engine_failed (it was edited; it cannot be read).
edge_result<bool> check_build(const prepare_image& request);

} // namespace roscell
