#pragma once

#include "skills/ros2/messages/builtin_interfaces.hpp"

#include <string>

namespace roscell::ros2 {

/// std_msgs/msg/Header
struct header {
  static constexpr const char* type_name = "std_msgs/msg/Header";

  time stamp;
  std::string frame_id;

  static constexpr auto fields() {
    return std::make_tuple(named("stamp", &header::stamp),
                           named("frame_id", &header::frame_id));
  }
};

/// std_msgs/msg/String
struct string {
  static constexpr const char* type_name = "std_msgs/msg/String";

  std::string data;

  static constexpr auto fields() {
    return std::make_tuple(named("data", &string::data));
  }
};

} // namespace roscell::ros2
