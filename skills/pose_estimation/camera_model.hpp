#pragma once

#include "roscell/ros2/sensor_msgs.hpp"
#include "skills/vision/lens.hpp"

#include <Eigen/Core>

#include <string>
#include <variant>

namespace roscell::pose {

/// How a camera maps directions to pixels. The camera frame is ROS's optical
/// frame: x to the right, y down, z forward, metres.
class camera_model {
public:
  /// Without distortion. Focal lengths and principal point in pixels.
  camera_model(double fx, double fy, double cx, double cy)
      : focal_{fx, fy}, centre_{cx, cy} {
    // nop
  }

  /// The model that a CameraInfo describes, or in one line what is wrong with
  /// it. Of a raw image, K and the distortion count; of a rectified one P, as
  /// in apriltag_ros.
  static std::variant<camera_model, std::string>
  of(const ros2::sensor_msgs::camera_info& info, bool rectified);

  /// The pixel at which a pinhole camera without distortion sees `point`.
  Eigen::Vector2d project(const Eigen::Vector3d& point) const;

  /// Where the pixel would be without distortion; no numbers where no pinhole
  /// camera sees that direction.
  Eigen::Vector2d undistort(const Eigen::Vector2d& pixel) const;

  /// Where distortion puts the pixel of a pinhole camera.
  Eigen::Vector2d distort(const Eigen::Vector2d& pixel) const;

  const Eigen::Vector2d& focal() const noexcept {
    return focal_;
  }

  /// Of an undistorted pixel, on the plane at distance 1.
  Eigen::Vector2d normalize(const Eigen::Vector2d& pixel) const {
    return (pixel - centre_).cwiseQuotient(focal_);
  }

private:
  Eigen::Vector2d to_pixel(const Eigen::Vector2d& direction) const {
    return direction.cwiseProduct(focal_) + centre_;
  }

  Eigen::Vector2d focal_;
  Eigen::Vector2d centre_;
  vision::lens lens_;
};

} // namespace roscell::pose
