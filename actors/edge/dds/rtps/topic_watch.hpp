#pragma once

#include <cstddef>
#include <map>
#include <mutex>
#include <string>
#include <vector>

namespace roscell {

/// A topic as ROS 2 names it, and its type: `/scan`, `sensor_msgs/msg/Image`.
struct written_topic {
  std::string topic;
  std::string data_type;

  friend bool operator==(const written_topic& x, const written_topic& y) {
    return x.topic == y.topic && x.data_type == y.data_type;
  }
};

/// The ROS 2 topics that somebody in a DDS domain writes. Topics and types of
/// other kinds are left out. May be used by several threads.
class topic_watch {
public:
  /// More writers than these are not remembered.
  static constexpr std::size_t most_writers = 4096;

  /// A writer was found, or found again; `writer` is its GUID in any form. The
  /// names are those of DDS: `rt/scan`, `sensor_msgs::msg::dds_::Image_`.
  void add(const std::string& writer, const std::string& topic,
           const std::string& type);

  void remove(const std::string& writer);

  /// One entry a writer.
  std::vector<written_topic> topics() const;

private:
  mutable std::mutex mutex_;
  std::map<std::string, written_topic> writers_;
};

} // namespace roscell
