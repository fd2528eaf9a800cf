#pragma once

#include "roscell/ros2/sensor_msgs.hpp"

#include <array>
#include <string>
#include <variant>

namespace roscell::vision {

/// How the lens of a camera bends directions, which are points on the plane at
/// distance 1: plumb_bob and rational_polynomial by the equations of OpenCV's
/// calib3d with up to 14 coefficients (k1, k2, p1, p2, k3 to k6, s1 to s4, and
/// the tilts of the sensor tau x and tau y in radians), equidistant by those of
/// its fisheye module. Without distortion until it is made from a CameraInfo.
class lens {
public:
  /// The lens that a CameraInfo describes, or in one line what is wrong with
  /// its distortion. Polynomials are told by the number of their coefficients,
  /// of which what is behind the last one that is not zero does not count.
  static std::variant<lens, std::string>
  of(const ros2::sensor_msgs::camera_info& info);

  struct point {
    double x = 0;
    double y = 0;
  };

  /// Where the lens shows a direction.
  point bend(const point& straight) const;

  /// The direction that the lens shows at a point: the inverse, by iteration.
  /// No numbers where an equidistant lens sees what is beside or behind it.
  point straighten(const point& bent) const;

  /// Whether there is any distortion.
  bool distorts() const noexcept {
    return kind_ != kind::none;
  }

private:
  enum class kind { none, polynomial, equidistant };
  using matrix = std::array<double, 9>; // 3x3, row by row.

  /// What a polynomial multiplies a direction with, and adds to it then.
  struct change {
    double radial = 1;
    double x = 0;
    double y = 0;
  };

  change change_at(const point& straight) const;
  point bend_equidistant(const point& straight) const;
  point straighten_equidistant(const point& bent) const;
  void tilt(double tau_x, double tau_y);

  kind kind_ = kind::none;
  /// k1, k2, p1, p2, k3 to k6, s1 to s4; or k1 to k4 of equidistant.
  std::array<double, 12> coefficients_{};
  bool tilted_ = false;
  matrix tilt_{};   ///< From the plane of the lens to that of the sensor.
  matrix untilt_{}; ///< Its inverse.
};

/// A CameraInfo describes the camera's full resolution, and apart from that
/// which part of it is sent and how coarsely. Returns one that describes the
/// images as they are sent, as image_geometry::PinholeCameraModel has it.
ros2::sensor_msgs::camera_info
describe_sent_images(ros2::sensor_msgs::camera_info info);

} // namespace roscell::vision
