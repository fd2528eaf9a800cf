#pragma once

#include "roscell/ros2/sensor_msgs.hpp"

#include <array>
#include <string>
#include <variant>

namespace roscell::vision {

/// How the lens of a camera bends directions, which are points on the plane at
/// distance 1: plumb_bob and rational_polynomial by equations (1) of OpenCV's
/// calib3d, equidistant by those of its fisheye module. Without distortion
/// until it is made from a CameraInfo.
class lens {
public:
  /// The lens that a CameraInfo describes, or in one line what is wrong with
  /// its distortion.
  static std::variant<lens, std::string>
  of(const ros2::sensor_msgs::camera_info& info);

  /// What distortion multiplies a direction with, and adds to it then.
  struct bend {
    double radial = 1;
    double x = 0;
    double y = 0;
  };

  bend bend_at(double x, double y) const;

  /// Whether there is any distortion.
  bool distorts() const noexcept {
    return kind_ != kind::none;
  }

private:
  enum class kind { none, polynomial, equidistant };

  bend bend_polynomial(double x, double y) const;
  bend bend_equidistant(double x, double y) const;

  kind kind_ = kind::none;
  /// k1, k2, p1, p2, k3, k4, k5, k6, or k1 to k4 of equidistant.
  std::array<double, 8> coefficients_{};
};

/// A CameraInfo describes the camera's full resolution, and apart from that
/// which part of it is sent and how coarsely. Returns one that describes the
/// images as they are sent, as image_geometry::PinholeCameraModel has it.
ros2::sensor_msgs::camera_info
describe_sent_images(ros2::sensor_msgs::camera_info info);

} // namespace roscell::vision
