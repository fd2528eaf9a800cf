#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace roscell::ros2 {

/// GUID of a participant or an endpoint: its prefix and its entity id.
using guid = std::array<std::uint8_t, 16>;

/// One participant and its one ROS 2 node, as the ROS graph shows them.
struct graph_node {
  guid participant{};
  std::string name; ///< Without a namespace.
  std::vector<guid> readers;
  std::vector<guid> writers;
};

/// On this topic, without a prefix, all participants describe themselves.
constexpr const char* graph_topic = "ros_discovery_info";

/// The DDS name of what they write there.
constexpr const char* graph_type =
    "rmw_dds_common::msg::dds_::ParticipantEntitiesInfo_";

/// A rmw_dds_common/msg/ParticipantEntitiesInfo. `gid_bytes` is 16 or 24: ROS 2
/// Humble and the later versions cannot read each other's.
std::string serialize(const graph_node& node, std::size_t gid_bytes);

} // namespace roscell::ros2
