#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/handlers.hpp"
#include "skills/pose_estimation/camera_model.hpp"
#include "skills/vision/complaint.hpp"
#include "skills/vision/paired_executor.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace roscell::pose {

/// What is known of the camera behind one image input. Says once, with the
/// remedy, why its images give no poses, and once when they do again.
class camera_source {
public:
  /// `name` is what a person calls the camera, e.g. the image's endpoint.
  /// `expects_info` is whether a CameraInfo input belongs to it.
  camera_source(const std::string& name, bool expects_info, bool rectified,
                engine::say_function say);

  using stamp = vision::stamped_calibrations::stamp;

  /// Takes the camera's calibration, the first one or a new one.
  void calibrate(stamp at, const ros2::sensor_msgs::camera_info& sent);

  /// Whether an image has to wait for its CameraInfo.
  bool should_wait(stamp image) {
    return expects_info_ && calibrations_.should_wait(image);
  }

  /// The model for an image of this stamp and size. Nothing if there is none:
  /// no CameraInfo yet, a bad one, or one of another size.
  std::optional<camera_model> model_for(stamp image, std::uint32_t width,
                                        std::uint32_t height);

private:
  void use(const ros2::sensor_msgs::camera_info& sent);
  std::string problem_with(std::uint32_t width, std::uint32_t height) const;

  const std::string name_;
  const engine::say_function say_;
  const bool expects_info_;
  const bool rectified_;
  vision::stamped_calibrations calibrations_;
  /// The one that the model is of, of images as they are sent.
  std::optional<ros2::sensor_msgs::camera_info> info_;
  bool change_said_ = false;
  std::optional<camera_model> model_;
  /// Why the last calibration gave no model.
  std::string fault_;
  vision::complaint complaint_;
  unsigned early_images_ = 0;
};

// What the step of a pose estimator reads and writes.

bool is_camera_info(const engine::stream& input);

/// Whether it is a message with an image, rather than a file.
bool is_image_message(const std::string& data_type);

/// Throws start_error for a type that the skill does not know.
void check_streams(const engine::environment& env);

/// A parameter that is a list with a text for each camera; all are empty where
/// it is absent. Throws start_error for any other number of texts.
std::vector<std::string> texts_of_cameras(const engine::parameters& options,
                                          const char* name,
                                          std::size_t cameras);

} // namespace roscell::pose
