#include "skills/pose_estimation/pose_covariance.hpp"

#include <Eigen/LU>

#include <algorithm>

namespace roscell::pose {

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
