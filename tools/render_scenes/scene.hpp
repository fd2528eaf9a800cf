#pragma once

#include <Eigen/Geometry>

#include <array>
#include <cstdint>
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

} // namespace roscell::scenes
