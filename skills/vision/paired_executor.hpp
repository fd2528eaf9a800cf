#pragma once

#include "roscell/ros2/sensor_msgs.hpp"
#include "roscell/skill/environment.hpp"
#include "roscell/skill/executor.hpp"

#include <chrono>
#include <cstddef>
#include <deque>
#include <optional>
#include <vector>

namespace roscell::vision {

/// A skill of cameras: the k-th CameraInfo input belongs to the k-th image
/// input. The two come on different ways, in any order, so that an image may
/// wait for the CameraInfo of its stamp: one of each camera, until the next one
/// comes.
class paired_executor : public engine::executor {
public:
  void process(const engine::frame& input, engine::emitter& output) final;

protected:
  /// The first image input is the main one.
  explicit paired_executor(const std::vector<engine::stream>& inputs);

  /// Input ports by the number of their camera.
  const std::vector<std::size_t>& image_ports() const noexcept {
    return image_ports_;
  }

  const std::vector<std::size_t>& info_ports() const noexcept {
    return info_ports_;
  }

  /// The number of the camera to which an input port belongs.
  std::size_t camera_of(std::size_t port) const {
    return camera_of_port_.at(port);
  }

private:
  virtual void calibrate(std::size_t camera, const engine::frame& info) = 0;

  /// Whether an image has to wait; asked once for each.
  virtual bool should_wait(std::size_t camera, const engine::frame& image) = 0;

  /// @param image of the input port that it names, now or in an earlier call.
  virtual void process_image(const engine::frame& image,
                             engine::emitter& output) = 0;

  void take_info(const engine::frame& info, engine::emitter& output);
  void take_image(const engine::frame& image, engine::emitter& output);

  std::vector<std::size_t> image_ports_;
  std::vector<std::size_t> info_ports_;
  std::vector<std::size_t> camera_of_port_;
  std::vector<std::optional<engine::frame>> waiting_; ///< By camera.
};

/// Which CameraInfo belongs to which image of a camera: the one of its stamp,
/// where the camera sends one with each image, else the last.
///
/// The two come on different ways, in any order. Once they were seen to have
/// the same stamps, an image that comes before its CameraInfo is to wait for
/// it: it may be the first one that is told otherwise.
class stamped_calibrations {
public:
  using stamp = std::chrono::system_clock::time_point;

  void add(stamp at, const ros2::sensor_msgs::camera_info& info);

  /// Whether an image of this stamp has to wait. Where CameraInfo does not come
  /// any more, only the first few do. To be asked once for each image.
  bool should_wait(stamp image);

  /// Null before the first. Until the next `add`.
  const ros2::sensor_msgs::camera_info* of(stamp image) const;

private:
  struct entry {
    stamp at;
    ros2::sensor_msgs::camera_info info;
  };

  std::deque<entry> entries_; ///< The newest is the last.
  stamp last_image_{};
  bool pairs_ = false;
  unsigned waits_in_vain_ = 0;
};

} // namespace roscell::vision
