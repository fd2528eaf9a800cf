#pragma once

#include "skills/ros2/messages/std_msgs.hpp"

#include <vector>

namespace roscell::ros2 {

/// apriltag_msgs/msg/Point: pixels, x to the right and y down.
struct april_tag_point {
  double x = 0;
  double y = 0;

  static constexpr auto fields() {
    return std::make_tuple(named("x", &april_tag_point::x),
                           named("y", &april_tag_point::y));
  }
};

/// apriltag_msgs/msg/AprilTagDetection
struct april_tag_detection {
  std::string family; ///< e.g. "tag36h11"
  std::int32_t id = 0;
  std::int32_t hamming = 0; ///< Bits that were corrected.
  float goodness = 0;       ///< Always 0 in apriltag_ros.
  float decision_margin = 0;
  april_tag_point centre;
  /// Bottom left, bottom right, top right, top left of the tag.
  std::array<april_tag_point, 4> corners{};
  std::array<double, 9> homography{}; ///< 3x3, row by row.

  static constexpr auto fields() {
    return std::make_tuple(
        named("family", &april_tag_detection::family),
        named("id", &april_tag_detection::id),
        named("hamming", &april_tag_detection::hamming),
        named("goodness", &april_tag_detection::goodness),
        named("decision_margin", &april_tag_detection::decision_margin),
        named("centre", &april_tag_detection::centre),
        named("corners", &april_tag_detection::corners),
        named("homography", &april_tag_detection::homography));
  }
};

/// apriltag_msgs/msg/AprilTagDetectionArray
struct april_tag_detection_array {
  static constexpr const char* type_name =
      "apriltag_msgs/msg/AprilTagDetectionArray";

  ros2::header header;
  std::vector<april_tag_detection> detections;

  static constexpr auto fields() {
    return std::make_tuple(
        named("header", &april_tag_detection_array::header),
        named("detections", &april_tag_detection_array::detections));
  }
};

} // namespace roscell::ros2
