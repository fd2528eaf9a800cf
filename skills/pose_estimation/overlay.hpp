#pragma once

#include "skills/pose_estimation/frame_result.hpp"
#include "skills/vision/image_codec.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>

namespace roscell::pose {

/// Draws what was found into a bgr8 picture of the same size as the image:
/// the outline of each tag in yellow with its bottom edge in magenta, its id,
/// and, if it has a pose, its axes x in red, y in green, z in blue, half as
/// long as the tag is wide.
void draw_overlay(const frame_result& result,
                  const std::optional<camera_model>& camera,
                  vision::picture& target);

struct colour {
  std::uint8_t blue;
  std::uint8_t green;
  std::uint8_t red;
};

/// Draws into a bgr8 picture. What lies outside of it is left out.
class canvas {
public:
  /// The middle of the upper left pixel is (0, 0).
  explicit canvas(vision::picture& target) : target_(target) {
    // nop
  }

  /// A line with smooth edges and round ends.
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to,
            double width_px, colour ink);

  /// The decimal digits of `value` on a dark ground, its middle at `centre`. A
  /// digit is 5 x 7 dots, a dot `dot_px` pixels wide.
  void number(const Eigen::Vector2d& centre, unsigned value, int dot_px,
              colour ink);

private:
  void blend(int x, int y, double share, colour ink);
  void fill(int left, int top, int width, int height, double share, colour ink);
  void digit(int left, int top, unsigned value, int dot_px, colour ink);

  vision::picture& target_;
};

} // namespace roscell::pose
