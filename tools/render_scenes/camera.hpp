#pragma once

#include "tools/render_scenes/scene.hpp"

#include <optional>

namespace roscell::scenes {

/// A camera with plumb_bob distortion. The middle of the upper left pixel is
/// (0, 0).
class camera {
public:
  explicit camera(const scene_options& options);

  Eigen::Vector2d pixel_of(const Eigen::Vector3d& point) const;

  /// A vector with z = 1 along which this pixel looks.
  Eigen::Vector3d ray_of(const Eigen::Vector2d& pixel) const;

  const Eigen::Vector2d& centre() const noexcept {
    return centre_;
  }

private:
  Eigen::Vector2d bent(const Eigen::Vector2d& straight) const;

  const double focal_px_;
  const Eigen::Vector2d centre_;
  const std::array<double, 5> distortion_;
  const bool distorted_;
};

} // namespace roscell::scenes
