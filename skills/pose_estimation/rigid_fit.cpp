#include "skills/pose_estimation/rigid_fit.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>

namespace roscell::pose {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;
using matrix26d = Eigen::Matrix<double, 2, 6>;

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d result;
  result << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return result;
}

rigid_transform move(const rigid_transform& pose, const vector6d& step) {
  const Vector3d turn = step.head<3>();
  const auto angle = turn.norm();
  Matrix3d rotation = Matrix3d::Identity();
  if (angle > 0)
    rotation = Eigen::AngleAxisd{angle, turn / angle}.toRotationMatrix();
  return {rotation * pose.rotation, pose.translation + step.tail<3>()};
}

/// How the pixel of `point` moves with the six numbers; `turned` is the point
/// of the body, turned but not moved.
matrix26d projection_slope(const Vector3d& point, const Vector3d& turned,
                           const Vector2d& focal) {
  Eigen::Matrix<double, 2, 3> of_point;
  const auto z = point.z();
  of_point << 1 / z, 0, -point.x() / (z * z), 0, 1 / z, -point.y() / (z * z);
  of_point = focal.asDiagonal() * of_point;
  matrix26d result;
  result << of_point * -cross_matrix(turned), of_point;
  return result;
}

} // namespace

rigid_transform rigid_fit::minimize(const rigid_transform& start) const {
  constexpr auto most_steps = 50;
  auto pose = start;
  auto damping = 1e-3;
  auto here = linearize(pose);
  for (auto i = 0; i < most_steps && damping < 1e9; ++i) {
    matrix6d damped = here.hessian;
    damped.diagonal() *= 1 + damping;
    const vector6d step = -damped.ldlt().solve(here.gradient);
    const auto next = move(pose, step);
    const auto there = linearize(next);
    if (!there.in_front || !(there.cost < here.cost)) {
      damping *= 10;
      continue;
    }
    const auto gain = here.cost - there.cost;
    pose = next;
    here = there;
    damping = std::max(damping / 10, 1e-9);
    if (gain < 1e-12 * here.cost)
      break;
  }
  return pose;
}

linearization rigid_fit::linearize(const rigid_transform& pose) const {
  linearization result;
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Vector3d turned = pose.rotation * points_[i];
    const Vector3d point = turned + pose.translation;
    if (!(point.z() > 0)) {
      result.in_front = false;
      return result;
    }
    const Vector2d residual = camera_.project(point) - pixels_[i];
    const auto slope = projection_slope(point, turned, camera_.focal());
    result.cost += residual.squaredNorm();
    result.hessian += slope.transpose() * slope;
    result.gradient += slope.transpose() * residual;
  }
  return result;
}

pose_covariance covariance_of(const linearization& at, std::size_t corners) {
  constexpr auto numbers_of_a_pose = 6.0;
  constexpr auto least_variance_px2 = 0.01;
  // A corner is two numbers, of which the pose explains six.
  const auto spare =
      std::max(2.0 * static_cast<double>(corners) - numbers_of_a_pose, 1.0);
  const auto variance = std::max(at.cost / spare, least_variance_px2);
  const matrix6d of_pose = variance * at.hessian.inverse();
  pose_covariance result{};
  // Turns come first in `of_pose`, and last in the message.
  for (auto row = 0; row < 6; ++row)
    for (auto column = 0; column < 6; ++column)
      result[static_cast<std::size_t>(6 * row + column)] =
          of_pose((row + 3) % 6, (column + 3) % 6);
  return result;
}

} // namespace roscell::pose
