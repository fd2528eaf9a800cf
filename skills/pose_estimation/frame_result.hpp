#pragma once

#include "roscell/ros2/apriltag_msgs.hpp"
#include "roscell/ros2/std_msgs.hpp"
#include "roscell/ros2/tf2_msgs.hpp"
#include "roscell/ros2/vision_msgs.hpp"
#include "skills/pose_estimation/bundle_pose.hpp"
#include "skills/pose_estimation/tag_detector.hpp"

#include <nlohmann/json.hpp>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace roscell::pose {

/// A tag that was found, with its pose if the camera is known.
struct found_tag {
  tag_detection detection;
  std::optional<tag_pose> pose;
  double size_m = 0;
  std::string frame;    ///< Its child frame, `tag36h11:7`.
  bool is_twin = false; ///< Another tag of the image has its id.
  bool in_tf = true;    ///< Whether the frame is this one's, and nobody else's.
};

/// A body several of whose tags are known.
struct found_bundle {
  std::string frame; ///< Its child frame.
  bundle_pose where;
  bool in_tf = true; ///< As of a tag.
};

/// All that one image gave.
struct frame_result {
  std::string frame_name; ///< What a person calls the image, e.g. its file.
  std::size_t source = 0; ///< Number of the image input.
  ros2::std_msgs::header header; ///< Of the image.
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::string family;
  std::vector<found_tag> tags;
  std::vector<found_bundle> bundles;
  std::chrono::nanoseconds processing_time{};
  /// From the image's stamp to this result; of use where the camera's clock is
  /// this machine's.
  std::chrono::nanoseconds age{};
};

/// One transform from the camera to each tag and each body with a pose whose
/// frame is its own.
ros2::tf2_msgs::tf_message to_tf_message(const frame_result& result);

/// Filled in as apriltag_ros does.
ros2::apriltag_msgs::april_tag_detection_array
to_detection_array(const frame_result& result);

/// A detection for each tag and each body with a pose, with its covariance; id
/// and class are its child frame, its box has the size 0.
ros2::vision_msgs::detection3_d_array
to_detection3d_array(const frame_result& result);

/// One object per image; lengths in metres, pixels where it says px:
///
///     { "frame": "frame_000.png", "source": 0, "frame_id": "camera",
///       "stamp": 1700000000.5, "width": 640, "height": 480,
///       "processing_ms": 3.2, "age_ms": 5.1, "tags": [ { "family": "tag36h11",
///       "id": 7, "hamming": 0, "decision_margin": 71.3, "centre_px": [x, y],
///       "corners_px": [[x, y], ...], "pose": { "position": [x, y, z],
///       "orientation": [x, y, z, w], "reprojection_error_px": 0.1 },
///       "frame": "tag36h11:7", "in_tf": true } ],
///       "bundles": [ { "frame": "pallet", "in_tf": true, "tags": [0, 1, 3],
///       "strayed": [2], "pose": { ..., "covariance": [36 numbers] } } ] }
///
/// `pose` of a tag is null when the camera is not known.
nlohmann::json to_json(const frame_result& result);

} // namespace roscell::pose
