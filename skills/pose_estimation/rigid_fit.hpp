#pragma once

#include "skills/pose_estimation/camera_model.hpp"

#include <Eigen/Geometry>

#include <array>
#include <vector>

namespace roscell::pose {

using matrix6d = Eigen::Matrix<double, 6, 6>;
using vector6d = Eigen::Matrix<double, 6, 1>;

/// Takes points of a body to the camera's optical frame.
struct rigid_transform {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero(); ///< metres

  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation * point + translation;
  }

  rigid_transform operator*(const rigid_transform& inner) const {
    return {rotation * inner.rotation, *this * inner.translation};
  }

  rigid_transform inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }
};

/// Squared reprojection error in pixels with its normal equations at one pose.
/// The six numbers of a pose are a small rotation about the camera's axes,
/// applied from the left, and a translation.
struct linearization {
  double cost = 0;
  matrix6d hessian = matrix6d::Zero(); ///< Of half the cost, Gauss-Newton.
  vector6d gradient = vector6d::Zero();
  bool in_front = true; ///< Of the camera, all points.
};

/// The fit of a rigid transform to points of a body and the pixels at which
/// they were seen, without distortion.
class rigid_fit {
public:
  explicit rigid_fit(const camera_model& camera) : camera_(camera) {
    // nop
  }

  void add(const Eigen::Vector3d& point, const Eigen::Vector2d& pixel) {
    points_.push_back(point);
    pixels_.push_back(pixel);
  }

  /// Levenberg-Marquardt: the pose with the least squared error near to
  /// `start`.
  rigid_transform minimize(const rigid_transform& start) const;

  linearization linearize(const rigid_transform& pose) const;

private:
  const camera_model& camera_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<Eigen::Vector2d> pixels_;
};

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
