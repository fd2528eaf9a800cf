#pragma once

#include "roscell/skill/typed_ports.hpp"
#include "skills/rectify/pixel_map.hpp"
#include "skills/vision/complaint.hpp"
#include "skills/vision/paired_executor.hpp"

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

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

/// Takes the distortion of the lens out of images, as image_proc's RectifyNode
/// does.
///
/// Inputs: sensor_msgs/msg/Image and sensor_msgs/msg/CameraInfo, as many of
/// each; the k-th ones belong together. Outputs, by data type:
/// sensor_msgs/msg/Image, and sensor_msgs/msg/CameraInfo as it came, with the
/// header of its image; P is what counts of it for a rectified image. The k-th
/// input feeds the k-th output of each type, or its only one.
///
/// Images of a camera without distortion are passed on as they are. As long as
/// a camera is not calibrated, or for another size, its images are left out,
/// and the log says so once. Bayer and YUV become bgr8 or bgr16, all other
/// encodings stay. An unknown encoding ends the skill.
class rectifier : public vision::paired_executor {
public:
  explicit rectifier(const engine::environment& env);

  /// `say` gets the lines for people.
  rectifier(const engine::environment& env, const engine::say_function& say);

  void release() override;

private:
  /// One image input, with what belongs to it.
  struct source {
    raw_camera camera;
    std::size_t images = engine::typed_outputs::none;
    std::size_t infos = engine::typed_outputs::none;
  };

  void calibrate(std::size_t camera, const engine::frame& info) override;
  bool should_wait(std::size_t camera, const engine::frame& image) override;
  void process_image(const engine::frame& input,
                     engine::emitter& output) override;

  std::vector<source> sources_;
};

} // namespace roscell::rectify
