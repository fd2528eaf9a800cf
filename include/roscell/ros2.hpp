#pragma once

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/image_view.hpp"
#include "roscell/ros2/stamp.hpp"
#include "roscell/skill/environment.hpp"
#include "roscell/skill/registry.hpp"

/// ROS 2 topics and messages without ROS 2: target `roscell::ros2`. The structs
/// of a package are in a header of its name, e.g.
/// "roscell/ros2/sensor_msgs.hpp".
namespace roscell::ros2 {

/// Adds the protocol `ros2`: an endpoint is the name of a ROS 2 topic, e.g.
/// "/scene_1/image", a data type that of a ROS 2 message, e.g.
/// "sensor_msgs/msg/Image", and the payload of a frame is the message as CDR,
/// as `serialize` of "roscell/ros2/cdr.hpp" makes it. What nodes and parameters
/// say about it is in skills/README.md, "Frames and QoS".
///
/// All ports of a skill share one DDS participant. To be called before the
/// process starts a thread, because it sets SKIP_DEFAULT_XML in the process's
/// environment: no file in the working directory may change how DDS works.
void add_ros2_protocol(engine::registry& target);

/// The same with another source than the process's environment.
void add_ros2_protocol(engine::registry& target,
                       const engine::variable_lookup& lookup);

} // namespace roscell::ros2
