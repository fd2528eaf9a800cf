#pragma once

#include "dds/server_addresses.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace roscell {

/// A GUID: the participant's prefix and the endpoint's id.
using endpoint_guid = std::array<std::uint8_t, 16>;

/// One end of a ROS 2 topic, in the words of ROS 2.
struct graph_endpoint {
  std::string topic;     ///< "/scene_1/image"
  std::string data_type; ///< "sensor_msgs/msg/Image"
  bool writes = false;
  bool reliable = false;
  std::string durability; ///< "volatile", "transient_local", ...
  /// Name of its DDS participant; empty: not known. A skill's is its ROS node's
  /// name, that of a stock program its enclave.
  std::string program;

  friend bool operator==(const graph_endpoint& x, const graph_endpoint& y) {
    return x.topic == y.topic && x.data_type == y.data_type
           && x.writes == y.writes && x.reliable == y.reliable
           && x.durability == y.durability && x.program == y.program;
  }
};

/// How many participants a discovery server knows.
struct participant_counts {
  std::size_t servers = 0; ///< Other discovery servers.
  std::size_t programs = 0;
};

/// The ends of ROS 2 topics that a discovery server knows. Those of other kinds
/// (services, what is no ROS 2) are left out. May be used by several threads.
class ros_graph {
public:
  /// More than these are not remembered.
  static constexpr std::size_t most_endpoints = 8192;
  static constexpr std::size_t most_participants = 4096;

  void name_participant(const guid_prefix& who, const std::string& name);

  /// Its endpoints go with it.
  void remove_participant(const guid_prefix& who);

  /// An endpoint was found, or found again. Topic and type are as DDS has them:
  /// `rt/scan`, `sensor_msgs::msg::dds_::Image_`.
  void add(const endpoint_guid& which, graph_endpoint end);

  void remove(const endpoint_guid& which);

  /// A discovery server has begun, or ended, to put in here what it knows. With
  /// the last one all of that ends.
  void begin_service();
  void end_service();

  /// Whether there is one. Else nothing is known of anybody.
  bool is_served();

  participant_counts participants();

  /// All of them, in the order of their GUIDs.
  std::vector<graph_endpoint> endpoints();

  /// `on_change` is called on any thread after a change, once until `endpoints`
  /// is called again; at once if there is something already.
  void watch(std::function<void()> on_change);

private:
  void report_change();

  std::mutex mutex_;
  std::map<guid_prefix, std::string> names_;
  std::map<endpoint_guid, graph_endpoint> endpoints_;
  std::function<void()> on_change_;
  bool reported_ = false;
  int servers_ = 0; ///< One may begin before the one before has ended.
};

} // namespace roscell
