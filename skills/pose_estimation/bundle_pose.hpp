#pragma once

#include "roscell/skill/parameters.hpp"
#include "skills/pose_estimation/rigid_fit.hpp"
#include "skills/pose_estimation/tag_detector.hpp"

#include <optional>
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

/// Where a body is, by those of its tags that are seen.
struct bundle_pose {
  rigid_transform pose; ///< From the body's frame to the camera's.
  pose_covariance covariance{};
  std::vector<int> used;    ///< Ids of the tags that agree with it.
  std::vector<int> strayed; ///< Ids of those that are not where they should be.
  /// Root mean square over all corners used; pixels without distortion.
  double reprojection_error_px = 0;
};

/// What the tags of a body tell.
struct body_sight {
  std::optional<bundle_pose> where;
  bool ambiguous = false; ///< Several tags are seen, but too few agree.
};

/// The pose that explains most tags, and of such ones their corners best. None
/// if no tag of it is seen, or no more than half of those that are agree on
/// one. `seen` has no id twice.
body_sight locate(const bundle& body, const std::vector<tag_detection>& seen,
                  const camera_model& camera);

} // namespace roscell::pose
