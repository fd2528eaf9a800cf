#include "skills/ros2/names.hpp"

#include "roscell/skill/errors.hpp"

#include <algorithm>
#include <array>

namespace roscell::ros2 {

namespace {

/// A DDS name of Fast DDS has 255 bytes; ROS 2 keeps 8 for prefix and suffix.
constexpr std::size_t max_topic_bytes = 247;

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

bool is_upper(char c) {
  return c >= 'A' && c <= 'Z';
}

bool is_name_character(char c) {
  return is_digit(c) || is_lower(c) || is_upper(c) || c == '_';
}

bool is_token(std::string_view text) {
  return !text.empty() && !is_digit(text.front())
         && std::all_of(text.begin(), text.end(), is_name_character);
}

bool is_topic(std::string_view text) {
  while (!text.empty()) {
    if (text.front() != '/')
      return false;
    text.remove_prefix(1);
    auto token = text.substr(0, text.find('/'));
    if (!is_token(token))
      return false;
    text.remove_prefix(token.size());
  }
  return true;
}

} // namespace

std::string dds_topic_name(const std::string& topic) {
  if (topic.empty() || topic.size() > max_topic_bytes || !is_topic(topic))
    throw engine::start_error(
        "'" + topic.substr(0, max_topic_bytes)
        + "' is no name of a ROS 2 topic; an endpoint of the protocol 'ros2' "
          "is like '/scene_1/image': words of letters, digits and '_' that "
          "begin with no digit, each after a '/', at most "
        + std::to_string(max_topic_bytes) + " bytes");
  return "rt" + topic;
}

std::string dds_type_name(const std::string& type) {
  constexpr std::string_view middle = "/msg/";
  auto at = type.find(middle);
  auto package = type.substr(0, at);
  auto name = at < type.size() ? type.substr(at + middle.size()) : "";
  if (!is_token(package) || !is_lower(package.front()) || !is_token(name)
      || !is_upper(name.front()))
    throw engine::start_error("'" + type
                              + "' is no type of a ROS 2 message; a data type "
                                "of the protocol 'ros2' is like "
                                "'sensor_msgs/msg/Image'");
  return package + "::msg::dds_::" + name + '_';
}

std::string node_name_for(std::string_view text) {
  constexpr std::size_t max_node_bytes = 255;
  std::string result{text.substr(0, max_node_bytes - 1)};
  std::replace_if(
      result.begin(), result.end(),
      [](char c) { return !is_name_character(c); }, '_');
  if (result.empty() || is_digit(result.front()))
    result.insert(0, 1, '_');
  return result;
}

bool begins_with_header(std::string_view type) {
  constexpr std::array<std::string_view, 24> types{
      "apriltag_msgs/msg/AprilTagDetectionArray",
      "geometry_msgs/msg/PointStamped",
      "geometry_msgs/msg/PoseArray",
      "geometry_msgs/msg/PoseStamped",
      "geometry_msgs/msg/PoseWithCovarianceStamped",
      "geometry_msgs/msg/TransformStamped",
      "geometry_msgs/msg/TwistStamped",
      "geometry_msgs/msg/WrenchStamped",
      "nav_msgs/msg/OccupancyGrid",
      "nav_msgs/msg/Odometry",
      "nav_msgs/msg/Path",
      "sensor_msgs/msg/BatteryState",
      "sensor_msgs/msg/CameraInfo",
      "sensor_msgs/msg/CompressedImage",
      "sensor_msgs/msg/FluidPressure",
      "sensor_msgs/msg/Image",
      "sensor_msgs/msg/Imu",
      "sensor_msgs/msg/JointState",
      "sensor_msgs/msg/LaserScan",
      "sensor_msgs/msg/MagneticField",
      "sensor_msgs/msg/NavSatFix",
      "sensor_msgs/msg/PointCloud2",
      "sensor_msgs/msg/Range",
      "sensor_msgs/msg/Temperature",
  };
  return std::find(types.begin(), types.end(), type) != types.end();
}

} // namespace roscell::ros2
