#include "tools/roscell/doctor/node/own_node.hpp"

#include "actors/edge/http/http_target.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "messages/insight/examination.hpp"
#include "tools/roscell/doctor/node/asked_nodes.hpp"

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <future>
#include <map>
#include <string>
#include <string_view>

namespace roscell::cli {

namespace {

using asked_checks = std::shared_future<examination>;

findings found_by_node(const asked_checks& look, const std::string& name) {
  try {
    findings result;
    for (const auto& x : look.get().found)
      if (x.check == name)
        result.push_back(x);
    if (result.empty())
      result.push_back({judgement::skipped, "the node does not check it"});
    return result;
  } catch (const std::exception& e) {
    return {finding_of_failure(e, judgement::skipped)};
  }
}

/// Whether a check is of what a node has for itself: its folders, its user's
/// rights, its limits. Where a node runs, only it knows them.
bool is_own_check(const std::string& name) {
  constexpr const char* names[] = {"disk",    "fsync",      "descriptors",
                                   "inotify", "engine",     "gpu",
                                   "skills",  "site-token", "skill-owners"};
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

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

std::vector<check> own_checks(const std::shared_ptr<const node_client>& node,
                              const std::vector<check>& checks) {
  const asked_checks look = std::async(std::launch::deferred, [node] {
    return node->ask({{"type", examination_query::type}}, longest_check)
        .get<examination>();
  });
  std::vector<check> result;
  for (const auto& x : checks)
    if (is_own_check(x.name))
      result.push_back({x.name, x.area, x.about,
                        [look, name = x.name](const checked_host& /*host*/) {
                          return found_by_node(look, name);
                        }});
  return result;
}

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

void follow_node_of(checked_host& host) {
  const auto& config = host.config;
  connection_options own;
  own.to = std::filesystem::absolute(config.socket.empty()
                                         ? config.data_dir / "node.sock"
                                         : config.socket)
               .string();
  try {
    const node_client node{own};
    follow_node(host, node, node.get("/v1/node").get<node_description>());
  } catch (const std::exception&) {
    return;
  }
}

} // namespace roscell::cli
