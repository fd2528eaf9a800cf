#pragma once

#include "messages/topic.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/check.hpp"

#include <optional>
#include <string>
#include <vector>

/// What the cameras of a cell say of themselves.
namespace roscell::cli {

/// Listens to each camera of the cell until it has told its calibration, and to
/// each topic of images until one has come.
findings check_cameras(const node_client& node);

/// @param k row-major 3 x 3, in pixels (sensor_msgs/msg/CameraInfo); none if
/// nothing came in time.
finding judge_camera(const topic_row& topic,
                     const std::optional<std::vector<double>>& k);

/// What one image of a camera says of all.
struct seen_image {
  std::string encoding;
  std::string fault; ///< Why its sizes make no sense; empty: they do.
};

/// @param seen none if no image came in time.
finding judge_images(const topic_row& topic,
                     const std::optional<seen_image>& seen);

} // namespace roscell::cli
