#pragma once

#include "roscell/skill/handlers.hpp"
#include "skills/pose_estimation/camera_model.hpp"
#include "skills/vision/complaint.hpp"

#include <optional>
#include <string>

namespace roscell::pose {

/// What is known of the camera behind one image input. Says once, with the
/// remedy, why its images give no poses, and once when they do again.
class camera_source {
public:
  /// `name` is what a person calls the camera, e.g. the image's endpoint.
  /// `expects_info` is whether a CameraInfo input belongs to it.
  camera_source(const std::string& name, bool expects_info, bool rectified,
                engine::say_function say);

  /// Takes the camera's calibration, the first one or a new one.
  void calibrate(const ros2::sensor_msgs::camera_info& sent);

  /// The model for an image of this size. Nothing if there is none: no
  /// CameraInfo yet, a bad one, or one of another size.
  std::optional<camera_model> model_for(std::uint32_t width,
                                        std::uint32_t height);

private:
  std::string problem_with(std::uint32_t width, std::uint32_t height) const;

  const bool expects_info_;
  const bool rectified_;
  std::optional<ros2::sensor_msgs::camera_info> info_;
  std::optional<camera_model> model_;
  /// Why the last calibration gave no model.
  std::string fault_;
  vision::complaint complaint_;
  unsigned early_images_ = 0;
};

} // namespace roscell::pose
