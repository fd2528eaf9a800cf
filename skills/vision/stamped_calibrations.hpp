#pragma once

#include "roscell/ros2/sensor_msgs.hpp"

#include <chrono>
#include <deque>

namespace roscell::vision {

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
