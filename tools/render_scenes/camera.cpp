#include "tools/render_scenes/camera.hpp"

#include <algorithm>

namespace roscell::scenes {

camera::camera(const scene_options& options)
    : focal_px_(options.focal_px),
      centre_((options.width - 1) / 2.0, (options.height - 1) / 2.0),
      distortion_(options.distortion),
      distorted_(std::any_of(distortion_.begin(), distortion_.end(),
                             [](double k) { return k != 0; })) {
  // nop
}

/// Brown and Conrady's model as ROS and OpenCV write it.
Eigen::Vector2d camera::bent(const Eigen::Vector2d& straight) const {
  const auto [k1, k2, p1, p2, k3] = distortion_;
  const auto x = straight.x();
  const auto y = straight.y();
  const auto r2 = x * x + y * y;
  const auto radial = 1 + k1 * r2 + k2 * r2 * r2 + k3 * r2 * r2 * r2;
  return {x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x),
          y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y};
}

Eigen::Vector2d camera::pixel_of(const Eigen::Vector3d& point) const {
  const Eigen::Vector2d straight = point.head<2>() / point.z();
  return focal_px_ * (distorted_ ? bent(straight) : straight) + centre_;
}

/// Inverts the distortion by correcting a guess by what it misses, which
/// converges as long as the distortion is mild.
Eigen::Vector3d camera::ray_of(const Eigen::Vector2d& pixel) const {
  const Eigen::Vector2d seen = (pixel - centre_) / focal_px_;
  auto straight = seen;
  for (auto i = 0; distorted_ && i < 20; ++i)
    straight += seen - bent(straight);
  return straight.homogeneous();
}

} // namespace roscell::scenes
