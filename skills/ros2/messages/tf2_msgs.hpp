#pragma once

#include "skills/ros2/messages/geometry_msgs.hpp"

#include <vector>

namespace roscell::ros2 {

/// tf2_msgs/msg/TFMessage
struct tf_message {
  static constexpr const char* type_name = "tf2_msgs/msg/TFMessage";

  std::vector<transform_stamped> transforms;

  static constexpr auto fields() {
    return std::make_tuple(named("transforms", &tf_message::transforms));
  }
};

} // namespace roscell::ros2
