#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <caf/result.hpp>

/// Container images that one node's engine has and another one's lacks.
namespace roscell {

/// Asks all nodes whether their engines know the image, has one of those make
/// a build of it, and offers that to the node that lacks it. Errors: see
/// `cell_coordinator_actor`.
caf::result<image_offered> offer_image(coordinator_pointer self,
                                       const image_request& request);

} // namespace roscell
