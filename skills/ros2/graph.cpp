#include "skills/ros2/graph.hpp"

#include "roscell/ros2/cdr.hpp"
#include "roscell/ros2/rmw_dds_common.hpp"
#include "roscell/ros2/rmw_dds_common_iron.hpp"

#include <algorithm>

namespace roscell::ros2 {

namespace {

template <class Gid>
Gid to_gid(const guid& x) {
  Gid result;
  std::copy(x.begin(), x.end(), result.data.begin());
  return result;
}

template <class Gid>
auto to_gids(const std::vector<guid>& list) {
  std::vector<Gid> result(list.size());
  std::transform(list.begin(), list.end(), result.begin(), to_gid<Gid>);
  return result;
}

template <class Message>
std::string serialize_as(const graph_node& node) {
  using gid = decltype(Message::gid);
  Message message;
  message.gid = to_gid<gid>(node.participant);
  message.node_entities_info_seq = {
      {"/", node.name, to_gids<gid>(node.readers), to_gids<gid>(node.writers)}};
  return serialize(message);
}

} // namespace

std::string serialize(const graph_node& node, std::size_t gid_bytes) {
  using humble = rmw_dds_common::participant_entities_info;
  using iron = rmw_dds_common_iron::participant_entities_info;
  return gid_bytes == 16 ? serialize_as<iron>(node)
                         : serialize_as<humble>(node);
}

} // namespace roscell::ros2
