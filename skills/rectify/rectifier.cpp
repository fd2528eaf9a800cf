#include "skills/rectify/rectifier.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/errors.hpp"
#include "roscell/skill/log_line.hpp"
#include "skills/vision/colours.hpp"

#include <utility>

namespace roscell::rectify {

namespace {

using engine::start_error;
using engine::typed_outputs;
using ros2::sensor_msgs::camera_info;
using ros2::sensor_msgs::image;

void check_types(const std::vector<engine::stream>& ends, const char* verb) {
  for (const auto& end : ends)
    if (end.data_type != image::type_name
        && end.data_type != camera_info::type_name)
      throw start_error("'" + end.endpoint + "' has the type '" + end.data_type
                        + "'; this skill " + verb
                        + " sensor_msgs/msg/Image and "
                          "sensor_msgs/msg/CameraInfo");
}

/// The raw image with other pixels, whose rows have no gaps.
std::string rectified(const ros2::image_view& raw, const pixel_map& map) {
  std::vector<std::uint8_t> storage;
  auto result = vision::to_plain_numbers(raw, storage);
  const auto pixels = remap(result, map);
  result.step = static_cast<std::uint32_t>(pixels.size() / raw.height);
  result.data = pixels.data();
  result.size = pixels.size();
  return ros2::serialize(result);
}

} // namespace

rectifier::rectifier(const engine::environment& env)
    : rectifier(env, [](const std::string& line) {
        engine::log_line("rectify: " + line);
      }) {
  // nop
}

rectifier::rectifier(const engine::environment& env,
                     const engine::say_function& say)
    : paired_executor(env.inputs) {
  check_types(env.inputs, "takes");
  check_types(env.outputs, "gives");
  const auto& images = image_ports();
  const auto& infos = info_ports();
  if (images.empty() || images.size() != infos.size())
    throw start_error("the step has " + std::to_string(images.size())
                      + " image and " + std::to_string(infos.size())
                      + " CameraInfo inputs; give each image input its "
                        "CameraInfo");
  typed_outputs to_images{env.outputs, image::type_name, images.size()};
  typed_outputs to_infos{env.outputs, camera_info::type_name, images.size()};
  for (std::size_t k = 0; k < images.size(); ++k)
    sources_.push_back({raw_camera{env.inputs[images[k]].endpoint, say},
                        to_images.of_source(k), to_infos.of_source(k)});
}

void rectifier::calibrate(std::size_t camera, const engine::frame& info) {
  sources_.at(camera).camera.calibrate(
      info.time, ros2::deserialize<camera_info>(info.payload));
}

bool rectifier::should_wait(std::size_t camera, const engine::frame& image) {
  return sources_.at(camera).camera.should_wait(image.time);
}

void rectifier::release() {
  // Everything is given back by destructors.
}

void rectifier::process_image(const engine::frame& input,
                              engine::emitter& output) {
  auto& from = sources_.at(camera_of(input.port));
  auto raw = ros2::view_image(input.payload);
  if (!from.camera.is_ready_for(input.time, raw.width, raw.height))
    return output.give_nothing(from.camera.problem());
  if (from.images != typed_outputs::none) {
    const auto* map = from.camera.map();
    output.emit(map == nullptr ? input.payload : rectified(raw, *map),
                from.images);
  }
  if (from.infos != typed_outputs::none) {
    auto info = from.camera.info();
    info.header = raw.header;
    output.emit(ros2::serialize(info), from.infos);
  }
}

} // namespace roscell::rectify
