#pragma once

#include <string>
#include <string_view>

/// How ROS 2 calls things on the DDS wire, see ros2/design,
/// 140_topic_and_service_name_mapping.
namespace roscell::ros2 {

/// "rt/scene_1/image" for the topic "/scene_1/image". Throws
/// engine::start_error when ROS 2 would refuse the name.
std::string dds_topic_name(const std::string& topic);

/// "sensor_msgs::msg::dds_::Image_" for "sensor_msgs/msg/Image". Throws
/// engine::start_error for what is no type of a ROS 2 message.
std::string dds_type_name(const std::string& type);

/// The nearest valid name of a ROS 2 node: every other character becomes '_'.
std::string node_name_for(std::string_view text);

/// Whether the messages of a type begin with a std_msgs/msg/Header, as far as
/// this is known.
bool begins_with_header(std::string_view type);

} // namespace roscell::ros2
