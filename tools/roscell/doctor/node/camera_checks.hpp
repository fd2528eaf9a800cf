#pragma once

#include "messages/topic.hpp"
#include "tools/roscell/client/node_client.hpp"
#include "tools/roscell/doctor/finding.hpp"

#include <optional>
#include <vector>

/// What the cameras of a cell say of themselves.
namespace roscell::cli {

/// Listens to each camera of the cell until it has told its calibration.
findings examine_cameras(const node_client& node);

/// @param k row-major 3 x 3, in pixels (sensor_msgs/msg/CameraInfo); none if
/// nothing came in time.
finding judge_camera(const topic_row& topic,
                     const std::optional<std::vector<double>>& k);

} // namespace roscell::cli
