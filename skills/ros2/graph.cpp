#include "skills/ros2/graph.hpp"

#include "skills/ros2/messages/cdr.hpp"

#include <algorithm>

namespace roscell::ros2 {

namespace {

template <std::size_t Bytes>
gid<Bytes> to_gid(const guid& x) {
  gid<Bytes> result;
  std::copy(x.begin(), x.end(), result.data.begin());
  return result;
}

template <std::size_t Bytes>
auto to_gids(const std::vector<guid>& list) {
  std::vector<gid<Bytes>> result(list.size());
  std::transform(list.begin(), list.end(), result.begin(), to_gid<Bytes>);
  return result;
}

template <std::size_t Bytes>
std::string serialize_as(const graph_node& node) {
  participant_entities_info<Bytes> message;
  message.gid = to_gid<Bytes>(node.participant);
  message.node_entities_info_seq = {{"/", node.name,
                                     to_gids<Bytes>(node.readers),
                                     to_gids<Bytes>(node.writers)}};
  return serialize(message);
}

} // namespace

std::string serialize(const graph_node& node, std::size_t gid_bytes) {
  return gid_bytes == 16 ? serialize_as<16>(node) : serialize_as<24>(node);
}

} // namespace roscell::ros2
