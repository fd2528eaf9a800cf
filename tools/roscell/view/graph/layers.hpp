#pragma once

#include <cstddef>
#include <utility>
#include <vector>

/// INTERNAL to drawings: which boxes stand beside each other, and which below.
namespace roscell::cli {

using graph_arc = std::pair<size_t, size_t>; ///< From a box to another one.

/// The boxes that hang together, each group in ascending order.
std::vector<std::vector<size_t>> components(size_t boxes,
                                            const std::vector<graph_arc>& arcs);

/// The layer of each box: below all boxes that it has an arc from, where arcs
/// go round in a circle, below those that come first.
std::vector<size_t> layers(size_t boxes, const std::vector<graph_arc>& arcs);

} // namespace roscell::cli
