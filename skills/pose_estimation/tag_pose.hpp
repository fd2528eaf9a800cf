#pragma once

#include "skills/pose_estimation/camera_model.hpp"
#include "skills/pose_estimation/rigid_fit.hpp"

#include <Eigen/Geometry>

#include <array>
#include <optional>
#include <vector>

namespace roscell::pose {

/// The corners of a tag in pixels: bottom left, bottom right, top right, top
/// left, as seen by somebody who reads the tag upright.
using tag_corners = std::array<Eigen::Vector2d, 4>;

/// Where a tag is in the camera's optical frame. The origin of the tag is its
/// middle; x points to its right, y to its top, z out of it to the viewer. A
/// tag that faces the camera upright has the rotation (x, y, z, w) =
/// (1, 0, 0, 0). This is the convention of apriltag_ros's method "pnp".
struct tag_pose {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(); ///< metres
  Eigen::Quaterniond orientation = Eigen::Quaterniond::Identity();
  /// Root mean square distance, over the four corners, between where a corner
  /// was seen and where this pose puts it: pixels of the raw image.
  double reprojection_error_px = 0;
  pose_covariance covariance{};
};

/// Corner points of a tag in its own frame, in the order of tag_corners.
std::array<Eigen::Vector3d, 4> tag_points(double tag_size_m);

/// The corners of a tag of this pose in the image, distortion included.
tag_corners project_corners(const tag_pose& pose, double tag_size_m,
                            const camera_model& camera);

/// The poses that explain the corners better than all near to them. None if the
/// corners are on a line, or no pose in front of the camera explains them.
///
/// Starts from the homography between tag and image (Hartley and Zisserman,
/// Multiple View Geometry, 8.1.1), then minimizes the squared reprojection
/// error by Levenberg-Marquardt. A flat target has a second local minimum, its
/// mirror image in depth (Schweighofer and Pinz, Robust Pose Estimation from a
/// Planar Target, PAMI 2006); both are tried.
std::vector<rigid_transform> pose_candidates(const tag_corners& corners,
                                             double tag_size_m,
                                             const camera_model& camera);

/// Of these the one with the least reprojection error.
std::optional<tag_pose> estimate_pose(const tag_corners& corners,
                                      double tag_size_m,
                                      const camera_model& camera);

} // namespace roscell::pose
