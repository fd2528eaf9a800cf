#pragma once

#include "roscell/skill/parameters.hpp"
#include "skills/pose_estimation/rigid_fit.hpp"

#include <string>
#include <vector>

namespace roscell::pose {

/// Where a tag is on its body.
struct bundled_tag {
  int id = 0;
  double size_m = 0;
  rigid_transform place; ///< From the tag's frame to the body's.
};

/// Several tags of one body.
struct bundle {
  std::string name; ///< Of the body's frame.
  std::vector<bundled_tag> tags;
};

/// The bundles of the parameter `bundles`, a list:
///
///     [ { "name": "pallet", "tags": [ { "id": 0, "size_m": 0.16,
///         "position": [x, y, z], "orientation": [x, y, z, w] }, ... ] } ]
///
/// `size_m` is `tag_size_m` if absent, `orientation` that of the body. Metres,
/// in the body's frame. Throws start_error, with the place, when one makes no
/// sense, and when an id is twice in them.
std::vector<bundle> bundles_of(const engine::parameters& options,
                               double tag_size_m);

} // namespace roscell::pose
