#pragma once

#include "skills/pose_estimation/rigid_fit.hpp"

#include <array>

namespace roscell::pose {

/// 6x6, row by row, as geometry_msgs/msg/PoseWithCovariance has it: of x, y, z
/// in metres and the turns about the camera's x, y and z in radians.
using pose_covariance = std::array<double, 36>;

/// What the errors of `corners` corners, seen independently of each other, make
/// of a pose: the variance of a pixel, which the squared reprojection error at
/// the best pose tells, times the inverse of the normal equations there. A
/// pixel is not taken for more exact than 0.1, because few corners may agree by
/// chance.
pose_covariance covariance_of(const linearization& at, std::size_t corners);

} // namespace roscell::pose
