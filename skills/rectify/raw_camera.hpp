#pragma once

#include "skills/rectify/pixel_map.hpp"
#include "skills/vision/complaint.hpp"
#include "skills/vision/stamped_calibrations.hpp"

#include <optional>
#include <string>

namespace roscell::rectify {

/// What is known of the camera behind one image input. Says once, with the
/// remedy, why its images cannot be rectified, and once when they can be again.
class raw_camera {
public:
  /// `name` is what a person calls the camera, e.g. the image's endpoint.
  raw_camera(const std::string& name, engine::say_function say);

  using stamp = vision::stamped_calibrations::stamp;

  /// Takes the camera's calibration, the first one or a new one.
  void calibrate(stamp at, const ros2::sensor_msgs::camera_info& info);

  /// Whether an image has to wait for its CameraInfo.
  bool should_wait(stamp image) {
    return calibrations_.should_wait(image);
  }

  /// Whether an image of this stamp and size can be rectified.
  bool is_ready_for(stamp image, std::uint32_t width, std::uint32_t height);

  /// Why images were not ready when it was asked last; empty: they were, or it
  /// is too early to tell.
  const std::string& problem() const {
    return problem_;
  }

  /// The map for images that `is_ready_for` has accepted; null when they have
  /// no distortion and so are rectified already. Made anew only for another
  /// calibration.
  const pixel_map* map();

  /// The calibration of that image as it came.
  const ros2::sensor_msgs::camera_info& info() const {
    return info_.value();
  }

private:
  std::string problem_with(std::uint32_t width, std::uint32_t height) const;

  void use(const ros2::sensor_msgs::camera_info& info);

  const std::string name_;
  const engine::say_function say_;
  vision::stamped_calibrations calibrations_;
  std::optional<ros2::sensor_msgs::camera_info> info_;
  bool change_said_ = false;
  ros2::sensor_msgs::camera_info sent_;
  vision::lens lens_;
  /// Why the last calibration is of no use.
  std::string fault_;
  std::optional<pixel_map> map_;
  vision::complaint complaint_;
  std::string problem_;
  unsigned early_images_ = 0;
};

} // namespace roscell::rectify
