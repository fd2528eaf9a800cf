#include "tools/roscell/doctor/node/follow_node.hpp"

#include "actors/edge/http/http_paths.hpp"
#include "actors/edge/io/socket_address.hpp"

#include <cstdlib>
#include <map>
#include <string>
#include <string_view>

namespace roscell::cli {

namespace {

/// The ports by which programs of the node's cell find each other.
void follow_cell(node_config& config, const node_client& node,
                 const std::map<std::string, std::string>& environment) {
  const auto hello = node.get(hello_path).get<node_hello>();
  config.public_domain_id = static_cast<uint8_t>(hello.public_domain);
  config.ros_domain_id = static_cast<uint8_t>(hello.domain_id);
  if (const auto x = environment.find("ROS_DOMAIN_ID"); x != environment.end())
    config.ros_domain_id = static_cast<uint8_t>(std::atoi(x->second.c_str()));
  const auto x = environment.find("ROS_DISCOVERY_SERVER");
  if (x == environment.end())
    return;
  // Behind the semicolons that say its id.
  if (const auto server = parse_socket_address(
          std::string_view{x->second}.substr(x->second.rfind(';') + 1)))
    config.discovery_port = server->port;
}

} // namespace

void follow_node(checked_host& host, const node_client& node,
                 const node_description& reported) {
  host.node_runs = true;
  if (const auto at = parse_socket_address(reported.identity.address)) {
    if (host.interface.empty())
      host.interface = at->address;
    host.config.http_port = at->port;
  }
  follow_cell(host.config, node, reported.environment);
}

} // namespace roscell::cli
