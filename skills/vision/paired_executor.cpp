#include "skills/vision/paired_executor.hpp"

#include "roscell/ros2/sensor_msgs.hpp"

#include <utility>

namespace roscell::vision {

namespace {

using ros2::sensor_msgs::camera_info;

} // namespace

paired_executor::paired_executor(const std::vector<engine::stream>& inputs) {
  for (const auto& input : inputs) {
    auto& ports =
        input.data_type == camera_info::type_name ? info_ports_ : image_ports_;
    ports.push_back(camera_of_port_.size());
    camera_of_port_.push_back(ports.size() - 1);
  }
  waiting_.resize(image_ports_.size());
  if (!image_ports_.empty())
    set_main_input(image_ports_.front());
}

void paired_executor::process(const engine::frame& input,
                              engine::emitter& output) {
  if (input.data_type == camera_info::type_name)
    take_info(input, output);
  else
    take_image(input, output);
}

void paired_executor::take_info(const engine::frame& info,
                                engine::emitter& output) {
  const auto camera = camera_of(info.port);
  calibrate(camera, info);
  auto& waiting = waiting_.at(camera);
  if (!waiting || waiting->time != info.time)
    return;
  const auto image = *std::exchange(waiting, std::nullopt);
  set_worked_on(image.port);
  process_image(image, output);
}

void paired_executor::take_image(const engine::frame& image,
                                 engine::emitter& output) {
  const auto camera = camera_of(image.port);
  auto& waiting = waiting_.at(camera);
  // What still waits has no CameraInfo of its own.
  if (const auto before = std::exchange(waiting, std::nullopt))
    process_image(*before, output);
  if (!should_wait(camera, image))
    return process_image(image, output);
  waiting = image;
  set_kept();
}

} // namespace roscell::vision
