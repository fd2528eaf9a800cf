#pragma once

#include "skills/ros2/messages/std_msgs.hpp"

namespace roscell::ros2 {

/// geometry_msgs/msg/Vector3: metres, where it is a translation.
struct vector3 {
  double x = 0;
  double y = 0;
  double z = 0;

  static constexpr auto fields() {
    return std::make_tuple(named("x", &vector3::x), named("y", &vector3::y),
                           named("z", &vector3::z));
  }
};

/// geometry_msgs/msg/Point: metres.
struct point {
  double x = 0;
  double y = 0;
  double z = 0;

  static constexpr auto fields() {
    return std::make_tuple(named("x", &point::x), named("y", &point::y),
                           named("z", &point::z));
  }
};

/// geometry_msgs/msg/Quaternion: of unit length.
struct quaternion {
  double x = 0;
  double y = 0;
  double z = 0;
  double w = 1;

  static constexpr auto fields() {
    return std::make_tuple(
        named("x", &quaternion::x), named("y", &quaternion::y),
        named("z", &quaternion::z), named("w", &quaternion::w));
  }
};

/// geometry_msgs/msg/Transform
struct transform {
  vector3 translation;
  quaternion rotation;

  static constexpr auto fields() {
    return std::make_tuple(named("translation", &transform::translation),
                           named("rotation", &transform::rotation));
  }
};

/// geometry_msgs/msg/TransformStamped: the child's pose in the frame of the
/// header.
struct transform_stamped {
  ros2::header header;
  std::string child_frame_id;
  ros2::transform transform;

  static constexpr auto fields() {
    return std::make_tuple(
        named("header", &transform_stamped::header),
        named("child_frame_id", &transform_stamped::child_frame_id),
        named("transform", &transform_stamped::transform));
  }
};

/// geometry_msgs/msg/Pose
struct pose {
  point position;
  quaternion orientation;

  static constexpr auto fields() {
    return std::make_tuple(named("position", &pose::position),
                           named("orientation", &pose::orientation));
  }
};

/// geometry_msgs/msg/PoseStamped
struct pose_stamped {
  static constexpr const char* type_name = "geometry_msgs/msg/PoseStamped";

  ros2::header header;
  ros2::pose pose;

  static constexpr auto fields() {
    return std::make_tuple(named("header", &pose_stamped::header),
                           named("pose", &pose_stamped::pose));
  }
};

} // namespace roscell::ros2
