#pragma once

#include "roscell/skill/executor.hpp"
#include "roscell/skill/typed_ports.hpp"
#include "skills/rectify/raw_camera.hpp"

#include <cstddef>
#include <optional>
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
class rectifier : public engine::executor {
public:
  explicit rectifier(const engine::environment& env);

  /// `say` gets the lines for people.
  rectifier(const engine::environment& env, const engine::say_function& say);

  void process(const engine::frame& input, engine::emitter& output) override;

  void release() override;

private:
  /// One image input, with what belongs to it.
  struct source {
    raw_camera camera;
    std::size_t images = engine::typed_outputs::none;
    std::size_t infos = engine::typed_outputs::none;
    std::optional<engine::frame> waiting; ///< An image, for its CameraInfo.
  };

  void process_info(const engine::frame& input, source& from,
                    engine::emitter& output);
  void take_image(const engine::frame& input, source& from,
                  engine::emitter& output);
  static void process_image(const engine::frame& input, source& from,
                            engine::emitter& output);

  std::vector<source> sources_;
  /// By input port: the number of its source.
  std::vector<std::size_t> source_of_port_;
};

} // namespace roscell::rectify
