#include "arm.hpp"

#include <algorithm>
#include <cmath>

namespace {

constexpr double upper_arm_m = 0.4;
constexpr double forearm_m = 0.4;
constexpr double shoulder_height_m = 0.3;
constexpr double fastest_rad_s = 2.0;

} // namespace

void arm::step(double seconds) {
  const double most = fastest_rad_s * seconds;
  for (std::size_t i = 0; i < joints; ++i)
    angles_[i] += std::clamp(target_[i] - angles_[i], -most, most);
}

position arm::wrist() const {
  const double elbow = angles_[1] + angles_[2];
  const double out =
      upper_arm_m * std::cos(angles_[1]) + forearm_m * std::cos(elbow);
  const double up =
      upper_arm_m * std::sin(angles_[1]) + forearm_m * std::sin(elbow);
  return {out * std::cos(angles_[0]), out * std::sin(angles_[0]),
          shoulder_height_m + up};
}

joint_angles reach(const position& goal) {
  const double up = goal.z - shoulder_height_m;
  const double out = std::hypot(goal.x, goal.y);
  constexpr double longest = upper_arm_m + forearm_m;
  const double distance = std::clamp(std::hypot(out, up), 0.05, longest);
  // The law of cosines in the triangle of shoulder, elbow and wrist.
  const double bend = std::acos(std::clamp(
      (distance * distance - upper_arm_m * upper_arm_m - forearm_m * forearm_m)
          / (2 * upper_arm_m * forearm_m),
      -1.0, 1.0));
  const double lift = std::atan2(up, out)
                      + std::atan2(forearm_m * std::sin(bend),
                                   upper_arm_m + forearm_m * std::cos(bend));
  return {std::atan2(goal.y, goal.x), lift, -bend, 0, 0, 0};
}
