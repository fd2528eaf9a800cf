#pragma once

#include "skills/pose_estimation/bundle.hpp"
#include "skills/pose_estimation/pose_covariance.hpp"
#include "skills/pose_estimation/tag_detector.hpp"

#include <optional>
#include <vector>

namespace roscell::pose {

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
