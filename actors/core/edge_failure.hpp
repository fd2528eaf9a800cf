#pragma once

#include "actors/edge/io/edge_error.hpp"
#include "messages/failure.hpp"

#include <caf/error.hpp>

namespace roscell {

/// What went wrong at the edge, as actors tell it.
inline caf::error to_caf(const edge_error& why) {
  return fail(why.code, why.message, "", why.hint);
}

} // namespace roscell
