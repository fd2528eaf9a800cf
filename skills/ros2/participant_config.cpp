#include "skills/ros2/participant_config.hpp"

#include "roscell/skill/errors.hpp"
#include "skills/engine/life/unique_fd.hpp"
#include "skills/ros2/names.hpp"

#include <arpa/inet.h>
#include <sys/socket.h>

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

} // namespace roscell::ros2
