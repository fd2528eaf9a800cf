#pragma once

#include "skills/vision/image_codec.hpp"

#include <Eigen/Core>

#include <cstdint>

namespace roscell::pose {

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
