#include "actors/edge/dds/rtps/topic_watch.hpp"

#include <string_view>

namespace roscell {

namespace {

constexpr std::string_view topic_prefix = "rt/";
constexpr std::string_view message_part = "::msg::dds_::";

/// `sensor_msgs/msg/Image` of `sensor_msgs::msg::dds_::Image_`; empty for any
/// other type.
std::string message_type(const std::string& type) {
  const auto part = type.find(message_part);
  if (part == std::string::npos || type.back() != '_')
    return {};
  const auto name = part + message_part.size();
  return type.substr(0, part) + "/msg/"
         + type.substr(name, type.size() - name - 1);
}

} // namespace

void topic_watch::add(const std::string& writer, const std::string& topic,
                      const std::string& type) {
  const auto data_type = message_type(type);
  if (topic.rfind(topic_prefix, 0) != 0 || data_type.empty())
    return;
  const std::lock_guard guard{mutex_};
  if (writers_.size() < most_writers || writers_.count(writer) > 0)
    writers_[writer] = {topic.substr(topic_prefix.size() - 1), data_type};
}

void topic_watch::remove(const std::string& writer) {
  const std::lock_guard guard{mutex_};
  writers_.erase(writer);
}

std::vector<written_topic> topic_watch::topics() const {
  const std::lock_guard guard{mutex_};
  std::vector<written_topic> result;
  for (const auto& [writer, topic] : writers_)
    result.push_back(topic);
  return result;
}

} // namespace roscell
