#pragma once

#include "roscell/skill/environment.hpp"
#include "roscell/skill/parameters.hpp"

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roscell::ros2 {

/// A DDS discovery server, as ROS 2 names it.
struct discovery_server {
  /// Its place in ROS_DISCOVERY_SERVER, and a part of its GUID prefix.
  std::uint8_t id = 0;
  std::string address; ///< IPv4.
  std::uint16_t port = 11811;
};

/// How a skill takes part in DDS.
struct participant_config {
  std::uint32_t domain_id = 0;
  /// Those who may tell us of others. Without any, others are found by
  /// multicast.
  std::vector<discovery_server> servers;
  std::string node_name;      ///< As it appears in the ROS graph.
  std::size_t gid_bytes = 24; ///< 24 for ROS 2 Humble, 16 for Iron and later.
};

/// Reads what a node tells its instances, in the variables of ROS 2:
///
/// | variable | value | if absent |
/// |---|---|---|
/// | ROS_DOMAIN_ID | 0 to 232 | 0 |
/// | ROS_DISCOVERY_SERVER | "ADDRESS[:PORT];..." where an empty place counts:
///   the server behind n semicolons has id n | simple discovery |
/// | ROSCELL_INSTANCE, ROSCELL_STEP, ROSCELL_OPERATION | the first that is
///   there names the ROS node | "skill" |
///
/// and the parameter `ros2_gid_bytes`, 16 or 24. Throws engine::start_error.
participant_config
read_participant_config(const engine::variable_lookup& lookup,
                        const engine::parameters& options);

/// The local IPv4 address from which `server` is reached. Throws
/// engine::start_error when there is no way.
std::string local_address_towards(const discovery_server& server);

// How ROS 2 calls things on the DDS wire, see ros2/design,
// 140_topic_and_service_name_mapping.

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
