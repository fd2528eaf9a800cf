#pragma once

#include "skills/ros2/messages/apriltag_msgs.hpp"
#include "skills/ros2/messages/cdr_error.hpp"
#include "skills/ros2/messages/geometry_msgs.hpp"
#include "skills/ros2/messages/image_view.hpp"
#include "skills/ros2/messages/rmw_dds_common.hpp"
#include "skills/ros2/messages/sensor_msgs.hpp"
#include "skills/ros2/messages/std_msgs.hpp"
#include "skills/ros2/messages/tf2_msgs.hpp"

#include <optional>
#include <string>
#include <string_view>

/// ROS 2 messages as bytes: the payload of a frame of the `ros2` protocol.
/// That is plain CDR (XCDR1), behind the 4 bytes that say so and in which byte
/// order. There are these two functions for every struct with a `type_name`.
namespace roscell::ros2 {

/// Little endian. Throws cdr_error when the message cannot be written: more
/// than 2^32 items, an image whose sizes do not agree.
template <class T>
std::string serialize(const T& message);

/// Takes either byte order. `payload` may come from anybody: every length is
/// checked against what is left of it before memory is taken. Throws cdr_error.
template <class T>
T deserialize(std::string_view payload);

/// The stamp of a message that begins with a Header; none if it has none.
std::optional<time> stamp_of(std::string_view payload);

template <>
std::string serialize(const image& message);

template <>
image deserialize(std::string_view payload);

} // namespace roscell::ros2
