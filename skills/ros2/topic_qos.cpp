#include "skills/ros2/topic_qos.hpp"

#include "roscell/skill/errors.hpp"

namespace roscell::ros2 {

namespace {

bool is_sensor_type(const std::string& type) {
  return type.rfind("sensor_msgs/", 0) == 0;
}

bool is_static_transform(const std::string& topic, const std::string& type) {
  const std::string last = "/tf_static";
  return type == "tf2_msgs/msg/TFMessage" && topic.size() >= last.size()
         && topic.compare(topic.size() - last.size(), last.size(), last) == 0;
}

topic_qos common_qos(const std::string& topic, const std::string& type) {
  topic_qos result;
  if (is_sensor_type(type)) {
    result.depth = 5;
    result.large = true;
  } else if (type == "tf2_msgs/msg/TFMessage") {
    result.depth = 100;
    result.transient_local = is_static_transform(topic, type);
  }
  return result;
}

/// Whether parameter `name` is `yes`, and not `no`.
bool choice(const engine::parameters& options, const char* name, bool fallback,
            const std::string& yes, const std::string& no) {
  auto text = options.text(name, fallback ? yes : no);
  if (text != yes && text != no)
    throw engine::start_error("parameter '" + std::string{name} + "' is '"
                              + text + "'; it must be '" + yes + "' or '" + no
                              + "'");
  return text == yes;
}

topic_qos with_parameters(topic_qos x, const engine::parameters& options) {
  x.reliable = choice(options, "ros2_reliability", x.reliable, "reliable",
                      "best_effort");
  x.transient_local = choice(options, "ros2_durability", x.transient_local,
                             "transient_local", "volatile");
  x.depth = static_cast<std::int32_t>(options.count(
      "ros2_depth", static_cast<std::uint64_t>(x.depth), 1, 1000));
  return x;
}

} // namespace

topic_qos reader_qos(const std::string& topic, const std::string& type,
                     const engine::parameters& options) {
  auto result = common_qos(topic, type);
  result.reliable = !is_sensor_type(type);
  return with_parameters(result, options);
}

topic_qos writer_qos(const std::string& topic, const std::string& type,
                     const engine::parameters& options) {
  auto result = common_qos(topic, type);
  if (is_static_transform(topic, type))
    result.depth = 1;
  return with_parameters(result, options);
}

} // namespace roscell::ros2
