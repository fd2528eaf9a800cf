#pragma once

#include "roscell/skill/parameters.hpp"

#include <cstdint>
#include <string>

namespace roscell::ros2 {

/// What two ends of a topic must agree on, and what ours keep.
struct topic_qos {
  /// Lost messages are sent again. A reader that wants this does not match a
  /// writer that does not offer it.
  bool reliable = true;
  /// The last messages are kept for readers that come later. A reader that
  /// wants this does not match a writer that does not offer it.
  bool transient_local = false;
  /// How many messages are kept, the last ones.
  std::int32_t depth = 10;
  /// Messages of this type may have megabytes. They are sent by a thread of
  /// their own, at a rate that receivers can take.
  bool large = false;
};

/// The defaults are those of ROS 2 (rmw/qos_profiles.h, tf2_ros/qos.hpp):
///
/// | type or topic | reader | writer |
/// |---|---|---|
/// | `sensor_msgs/msg/*` | best effort, depth 5 | reliable, depth 5 |
/// | `tf2_msgs/msg/TFMessage` | reliable, depth 100 | the same |
/// | the same on a topic `.../tf_static` | and transient local | and depth 1 |
/// | all others | reliable, depth 10 | the same |
///
/// These parameters of a step replace them, for all its ports:
///
/// | parameter | values |
/// |---|---|
/// | ros2_reliability | "reliable", "best_effort" |
/// | ros2_durability | "volatile", "transient_local" |
/// | ros2_depth | 1 to 1000 |
///
/// Both throw engine::start_error for other values.
topic_qos reader_qos(const std::string& topic, const std::string& type,
                     const engine::parameters& options);
topic_qos writer_qos(const std::string& topic, const std::string& type,
                     const engine::parameters& options);

} // namespace roscell::ros2
