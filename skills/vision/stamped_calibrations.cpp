#include "skills/vision/stamped_calibrations.hpp"

#include <algorithm>

namespace roscell::vision {

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
