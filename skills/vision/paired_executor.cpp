#include "skills/vision/paired_executor.hpp"

#include "roscell/ros2/sensor_msgs.hpp"

#include <algorithm>
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

void stamped_calibrations::add(stamp at,
                               const ros2::sensor_msgs::camera_info& info) {
  // As many images as may be on their way.
  constexpr std::size_t most_entries = 8;
  if (at == last_image_) {
    pairs_ = true;
    waits_in_vain_ = 0;
  }
  entries_.push_back({at, info});
  if (entries_.size() > most_entries)
    entries_.pop_front();
}

bool stamped_calibrations::should_wait(stamp image) {
  constexpr auto patience = 3U;
  last_image_ = image;
  if (entries_.empty())
    return false;
  if (image == entries_.back().at) {
    pairs_ = true;
    waits_in_vain_ = 0;
  }
  if (!pairs_ || image <= entries_.back().at || waits_in_vain_ == patience)
    return false;
  ++waits_in_vain_;
  return true;
}

const ros2::sensor_msgs::camera_info*
stamped_calibrations::of(stamp image) const {
  if (entries_.empty())
    return nullptr;
  const auto found = std::find_if(entries_.rbegin(), entries_.rend(),
                                  [&](const auto& x) { return x.at == image; });
  return found != entries_.rend() ? &found->info : &entries_.back().info;
}

} // namespace roscell::vision
