#pragma once

#include "messages/resources.hpp"

namespace roscell {

/// Adds an instance's reservation to what is in use on its node: GPU memory on
/// the GPU of that index, or in the node's pool where memory is unified.
void reserve(node_resources& node, const resource_request& request, int gpu);

} // namespace roscell
