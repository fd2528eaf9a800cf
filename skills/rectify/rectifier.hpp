#pragma once

#include "roscell/skill/typed_ports.hpp"
#include "skills/rectify/raw_camera.hpp"
#include "skills/vision/paired_executor.hpp"

#include <cstddef>
#include <vector>

namespace roscell::rectify {

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
