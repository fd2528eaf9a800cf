#pragma once

#include "messages/codec/described.hpp"

#include <string>
#include <vector>

namespace roscell {

/// One program's end of a topic.
struct topic_end {
  /// Name of its DDS participant: the instance, or the enclave of a stock
  /// ROS 2 program, which is "/" unless it was given another.
  std::string program;
  std::string reliability; ///< "reliable" or "best_effort".
  std::string durability;  ///< "volatile", "transient_local", ...

  static constexpr auto fields() {
    return field_list{required("program", &topic_end::program),
                      required("reliability", &topic_end::reliability),
                      required("durability", &topic_end::durability)};
  }
};

/// A topic under one type. The same name under another type is another row:
/// their ends do not match.
struct topic_row {
  std::string topic;     ///< "/scene_1/image"
  std::string data_type; ///< "sensor_msgs/msg/Image"
  std::vector<topic_end> writers;
  std::vector<topic_end> readers;
  /// Each pair whose QoS does not match, in a sentence.
  std::vector<std::string> mismatches;

  static constexpr auto fields() {
    return field_list{required("topic", &topic_row::topic),
                      required("data_type", &topic_row::data_type),
                      required("writers", &topic_row::writers),
                      required("readers", &topic_row::readers),
                      optional("mismatches", &topic_row::mismatches)};
  }
};

/// Asks a coordinator for the ROS 2 topics of its cell.
struct topic_query {
  static constexpr const char* type = "topic_query";
  std::string topic; ///< Empty: all.

  static constexpr auto fields() {
    return field_list{optional("topic", &topic_query::topic)};
  }
};

struct topic_list {
  static constexpr const char* type = "topic_list";
  std::vector<topic_row> topics; ///< By name.

  static constexpr auto fields() {
    return field_list{required("topics", &topic_list::topics)};
  }
};

} // namespace roscell
