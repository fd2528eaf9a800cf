#include "skills/ros2/participant_config.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/engine/life/unique_fd.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <optional>
#include <string_view>

namespace roscell::ros2 {

namespace {

/// Beyond, the ports that DDS derives from the domain do not exist.
constexpr std::uint64_t max_domain_id = 232;

std::string text_of(const engine::variable_lookup& lookup, const char* name) {
  const auto* value = lookup(name);
  return value != nullptr ? value : "";
}

std::optional<std::uint64_t> parse_number(std::string_view text) {
  std::uint64_t result = 0;
  const auto* end = text.data() + text.size();
  auto [rest, error] = std::from_chars(text.data(), end, result);
  if (error != std::errc{} || rest != end)
    return std::nullopt;
  return result;
}

std::uint32_t read_domain(const engine::variable_lookup& lookup) {
  auto text = text_of(lookup, "ROS_DOMAIN_ID");
  if (text.empty())
    return 0;
  auto number = parse_number(text);
  if (!number || *number > max_domain_id)
    throw engine::start_error("ROS_DOMAIN_ID is '" + text
                              + "'; it must be a whole number from 0 to "
                              + std::to_string(max_domain_id));
  return static_cast<std::uint32_t>(*number);
}

bool is_ipv4(const std::string& text) {
  in_addr address{};
  return ::inet_pton(AF_INET, text.c_str(), &address) == 1;
}

discovery_server parse_server(std::string_view text, std::size_t place) {
  discovery_server result;
  auto colon = text.find(':');
  result.address = text.substr(0, colon);
  auto port = colon == std::string_view::npos
                  ? std::uint64_t{result.port}
                  : parse_number(text.substr(colon + 1)).value_or(0);
  if (!is_ipv4(result.address) || port == 0 || port > 65535 || place > 255)
    throw engine::start_error(
        "ROS_DISCOVERY_SERVER has '" + std::string{text} + "' in place "
        + std::to_string(place)
        + "; it must be like '10.0.0.5:11811', in one of the places 0 to 255");
  result.id = static_cast<std::uint8_t>(place);
  result.port = static_cast<std::uint16_t>(port);
  return result;
}

std::vector<discovery_server>
read_servers(const engine::variable_lookup& lookup) {
  std::vector<discovery_server> result;
  const auto list = text_of(lookup, "ROS_DISCOVERY_SERVER");
  std::string_view rest = list;
  for (std::size_t place = 0; !rest.empty(); ++place) {
    auto entry = rest.substr(0, rest.find(';'));
    if (!entry.empty())
      result.push_back(parse_server(entry, place));
    rest.remove_prefix(std::min(rest.size(), entry.size() + 1));
  }
  // Silently taking part in multicast would reach beyond the cell.
  if (!list.empty() && result.empty())
    throw engine::start_error("ROS_DISCOVERY_SERVER is '" + list
                              + "', which names no server; unset it for "
                                "discovery by multicast");
  return result;
}

std::string read_node_name(const engine::variable_lookup& lookup) {
  for (const char* name :
       {"ROSCELL_INSTANCE", "ROSCELL_STEP", "ROSCELL_OPERATION"})
    if (auto text = text_of(lookup, name); !text.empty())
      return node_name_for(text);
  return "skill";
}

} // namespace

participant_config
read_participant_config(const engine::variable_lookup& lookup,
                        const engine::parameters& options) {
  participant_config result;
  result.domain_id = read_domain(lookup);
  result.servers = read_servers(lookup);
  result.node_name = read_node_name(lookup);
  result.gid_bytes = options.count("ros2_gid_bytes", 24, 16, 24);
  if (result.gid_bytes != 16 && result.gid_bytes != 24)
    throw engine::start_error("parameter 'ros2_gid_bytes' is "
                              + std::to_string(result.gid_bytes)
                              + "; it must be 24 for ROS 2 Humble, or 16 for "
                                "Iron and later");
  return result;
}

std::string local_address_towards(const discovery_server& server) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(server.port);
  ::inet_pton(AF_INET, server.address.c_str(), &address.sin_addr);
  auto* generic = reinterpret_cast<sockaddr*>(&address);
  socklen_t size = sizeof(address);
  // Connecting a UDP socket sends nothing; it only asks the routing table.
  engine::unique_fd asking{::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)};
  if (::connect(asking.get(), generic, size) != 0
      || ::getsockname(asking.get(), generic, &size) != 0)
    throw engine::start_error("there is no route to the discovery server "
                              + server.address + ": " + std::strerror(errno)
                              + "; correct ROS_DISCOVERY_SERVER or the "
                                "container's network");
  std::array<char, INET_ADDRSTRLEN> text{};
  return ::inet_ntop(AF_INET, &address.sin_addr, text.data(), text.size());
}

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
