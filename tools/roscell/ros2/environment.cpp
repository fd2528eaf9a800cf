#include "tools/roscell/ros2/environment.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "dds/server_addresses.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

namespace roscell::cli {

namespace {

/// Each of them leads a program elsewhere.
constexpr const char* misleading =
    "unset ROS_LOCALHOST_ONLY ROS_AUTOMATIC_DISCOVERY_RANGE ROS_STATIC_PEERS "
    "FASTDDS_ENVIRONMENT_FILE";

std::string in_quotes_of_shell(const std::string& text) {
  std::string result = "'";
  for (const char c : text)
    result += c == '\'' ? std::string{"'\\''"} : std::string{c};
  return result + "'";
}

/// What a node says becomes lines that a shell evaluates, so only what is meant
/// is taken, and a comment stays one line.
constexpr std::array<const char*, 2> known_names{"ROS_DISCOVERY_SERVER",
                                                 "ROS_DOMAIN_ID"};

bool is_known(const std::string& name) {
  return std::find(known_names.begin(), known_names.end(), name)
         != known_names.end();
}

std::string export_line(const std::string& name, const std::string& value) {
  return "export " + name + "=" + in_quotes_of_shell(value) + "\n";
}

std::string prefix_text(const guid_prefix& prefix) {
  std::string result;
  for (const auto byte : prefix) {
    std::array<char, 4> text{};
    std::snprintf(text.data(), text.size(), "%02x", byte);
    result += (result.empty() ? "" : ".") + std::string{text.data()};
  }
  return result;
}

} // namespace

std::string shell_lines(const std::string& cell, const variables& environment) {
  auto result = "# ROS 2 programs that this shell starts are in cell '"
                + printable(cell) + "'.\n" + misleading
                + " FASTRTPS_DEFAULT_PROFILES_FILE\n";
  for (const auto& [name, value] : environment)
    if (is_known(name))
      result += export_line(name, value);
  return result + export_line("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp");
}

std::string super_client_lines(const std::string& cell,
                               const variables& environment,
                               const std::filesystem::path& profile) {
  auto result = "# ROS 2 programs that this shell starts see all of cell '"
                + printable(cell)
                + "'.\n# A daemon of the ros2 command that runs already "
                  "does not: `ros2 daemon stop` ends it.\n"
                + misleading + "\n";
  for (const auto& [name, value] : environment)
    if (is_known(name))
      result += name == "ROS_DISCOVERY_SERVER" ? "unset " + name + "\n"
                                               : export_line(name, value);
  return result + export_line("RMW_IMPLEMENTATION", "rmw_fastrtps_cpp")
         + export_line("FASTRTPS_DEFAULT_PROFILES_FILE", profile.string());
}

std::string super_client_profile(const variables& environment) {
  const auto said = environment.find("ROS_DISCOVERY_SERVER");
  const auto value = said == environment.end() ? std::string{} : said->second;
  const auto id = value.find_first_not_of(';');
  const auto at = id == std::string::npos
                      ? std::nullopt
                      : parse_socket_address(value.substr(id));
  if (!at || id > UINT8_MAX)
    throw command_error{exit_refused,
                        "the node says no discovery server of its cell",
                        "`roscell status` shows whether it is in a cell"};
  const auto prefix = prefix_text(server_prefix(static_cast<uint8_t>(id)));
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<dds xmlns="http://www.eprosima.com/XMLSchemas/fastRTPS_Profiles">
  <profiles>
    <participant profile_name="roscell_super_client" is_default_profile="true">
      <rtps><builtin><discovery_config>
        <discoveryProtocol>SUPER_CLIENT</discoveryProtocol>
        <discoveryServersList>
          <RemoteServer prefix=")"
         + prefix + R"(">
            <metatrafficUnicastLocatorList><locator><udpv4>
              <address>)"
         + at->address + R"(</address><port>)" + std::to_string(at->port)
         + R"(</port>
            </udpv4></locator></metatrafficUnicastLocatorList>
          </RemoteServer>
        </discoveryServersList>
      </discovery_config></builtin></rtps>
    </participant>
  </profiles>
</dds>
)";
}

} // namespace roscell::cli
