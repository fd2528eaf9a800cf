#pragma once

#include "skills/ros2/messages/fields.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace roscell::ros2 {

/// rmw_dds_common/msg/Gid: which endpoint. ROS 2 Humble has 24 bytes, of which
/// DDS fills 16; Iron and later have 16.
template <std::size_t Bytes>
struct gid {
  std::array<std::uint8_t, Bytes> data{};

  static constexpr auto fields() {
    return std::make_tuple(named("data", &gid::data));
  }
};

/// rmw_dds_common/msg/NodeEntitiesInfo
template <std::size_t GidBytes>
struct node_entities_info {
  std::string node_namespace;
  std::string node_name;
  std::vector<gid<GidBytes>> reader_gid_seq;
  std::vector<gid<GidBytes>> writer_gid_seq;

  static constexpr auto fields() {
    return std::make_tuple(
        named("node_namespace", &node_entities_info::node_namespace),
        named("node_name", &node_entities_info::node_name),
        named("reader_gid_seq", &node_entities_info::reader_gid_seq),
        named("writer_gid_seq", &node_entities_info::writer_gid_seq));
  }
};

/// rmw_dds_common/msg/ParticipantEntitiesInfo: all nodes of one participant.
template <std::size_t GidBytes>
struct participant_entities_info {
  static constexpr const char* type_name =
      "rmw_dds_common/msg/ParticipantEntitiesInfo";

  ros2::gid<GidBytes> gid;
  std::vector<node_entities_info<GidBytes>> node_entities_info_seq;

  static constexpr auto fields() {
    return std::make_tuple(
        named("gid", &participant_entities_info::gid),
        named("node_entities_info_seq",
              &participant_entities_info::node_entities_info_seq));
  }
};

} // namespace roscell::ros2
