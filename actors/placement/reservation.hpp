#pragma once

#include "messages/resources.hpp"

#include <string>
#include <vector>

namespace roscell {

/// Adds an instance's reservation to what is in use on its node: GPU memory on
/// the GPU of that index, or in the node's pool where memory is unified.
void reserve(node_resources& node, const resource_request& request, int gpu);

/// What a node is short of for an instance, a sentence each; empty if it fits.
std::vector<std::string> shortages(const node_resources& node,
                                   const resource_request& request, int gpu);

} // namespace roscell
