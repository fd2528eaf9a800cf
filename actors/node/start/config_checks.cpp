#include "actors/node/start/config_checks.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/host/interfaces.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "messages/failure.hpp"
#include "messages/messages.hpp"
#include "schemas/message_catalogue.hpp"

#include <string>
#include <variant>

namespace roscell {

namespace {

constexpr uint16_t default_discovery_port = 11811;

/// Refuses words that would make every message of this node invalid.
caf::error check_words(const std::string& option,
                       const node_resources& resources) {
  const auto errors = document_errors("resource_report",
                                      message_json(resource_report{resources}),
                                      unknown_members::taken);
  if (errors.empty())
    return caf::none;
  return fail(error_code::schema_violation, option + ": " + errors[0].expected);
}

caf::error check_words(const node_config& config) {
  node_resources plain;
  plain.architecture = "amd64";
  plain.name = config.name;
  if (auto why = check_words("--name", plain))
    return why;
  plain.name = config.cell;
  if (auto why = check_words("--cell", plain))
    return why;
  plain.labels = config.labels;
  if (auto why = check_words("--label", plain))
    return why;
  plain.devices = config.devices;
  return check_words("--device", plain);
}

} // namespace

caf::error complete_config(node_config& config) {
  auto chosen = resolve_interface(config.address);
  if (auto* why = std::get_if<edge_error>(&chosen))
    return to_caf(*why);
  config.address = std::get<interface_address>(chosen).address;
  if (config.name.empty())
    config.name = mac_node_name(config.address);
  if (config.cell.empty())
    config.cell = config.name;
  if (auto why = check_words(config))
    return why;
  if (config.coordinator && !config.join.empty())
    return fail(error_code::schema_violation,
                "a coordination node does not join another cell", "",
                "leave out --join or --coordinator");
  if (config.wait && (config.coordinator || !config.join.empty()))
    return fail(error_code::schema_violation,
                "a node that waits to be chosen neither coordinates a cell nor "
                "joins one",
                "", "leave out --wait");
  if (config.join.empty())
    return caf::none;
  const auto server = parse_host_address(config.join, default_discovery_port);
  if (!server)
    return fail(
        error_code::schema_violation,
        "'" + config.join + "' is not the address of a discovery server", "",
        "give --join HOST[:PORT], such as 10.0.0.1, 10.0.0.1:11811 or "
        "base.local");
  config.join = to_string(*server);
  return caf::none;
}

} // namespace roscell
