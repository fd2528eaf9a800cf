#pragma once

#include "skills/engine/environment.hpp"
#include "skills/engine/registry.hpp"

namespace roscell::ros2 {

/// Adds the protocol `ros2`: an endpoint is the name of a ROS 2 topic, e.g.
/// "/scene_1/image", a data type that of a ROS 2 message, e.g.
/// "sensor_msgs/msg/Image", and the payload of a frame is the message as CDR,
/// as `serialize` of messages/cdr.hpp makes it. What nodes and parameters say
/// about it is read by participant_config.hpp and topic_qos.hpp.
///
/// All ports of a skill share one DDS participant. To be called before the
/// process starts a thread, because it sets SKIP_DEFAULT_XML in the process's
/// environment: no file in the working directory may change how DDS works.
void add_ros2_protocol(engine::registry& target);

/// The same with another source than the process's environment.
void add_ros2_protocol(engine::registry& target,
                       const engine::variable_lookup& lookup);

} // namespace roscell::ros2
