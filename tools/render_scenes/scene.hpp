#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace roscell::scenes {

/// What a scene looks like. The camera's middle pixels see along its z axis.
struct scene_options {
  unsigned tags = 4;
  std::string family = "tag36h11";
  double tag_size_m = 0.16; ///< Width of the black border, corner to corner.
  int width = 1280;         ///< pixels
  int height = 960;         ///< pixels
  double focal_px = 1000;
  /// k1, k2, p1, p2, k3 of ROS's plumb_bob.
  std::array<double, 5> distortion{};
  double nearest_m = 0.5;
  double farthest_m = 3;
  double most_tilt_deg = 45; ///< Against the line of sight.
  double blur_px = 0.6;      ///< Standard deviation of a Gaussian.
  double noise = 3;          ///< Standard deviation, of 255 levels.
  unsigned frames = 10;      ///< They differ in their noise only.
  std::uint64_t seed = 1;
};

/// A tag and its true pose in the camera's optical frame (x right, y down, z
/// forward). The tag's x points to its right, y to its top, z to its viewer.
struct placed_tag {
  int id = 0;
  Eigen::Vector3d position; ///< Of its middle, metres.
  Eigen::Quaterniond orientation;
};

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

/// The corners in pixels of a square of `size_m` around the middle of a tag:
/// bottom left, bottom right, top right, top left.
std::array<Eigen::Vector2d, 4> corners_of(const placed_tag& tag, double size_m,
                                          const camera& eye);

/// Random poses, the same for the same seed: tags 0, 1, ... in view with their
/// white margin of `margin` times the tag's size, none in front of another.
/// Where there are many, they begin farther away than `nearest_m`. Throws
/// std::runtime_error when so many do not fit.
std::vector<placed_tag> place_tags(const scene_options& options, double margin);

} // namespace roscell::scenes
