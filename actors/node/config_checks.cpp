#include "actors/node/config_checks.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/host/interfaces.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/process/privileges.hpp"
#include "actors/edge/trust/identity_file.hpp"
#include "actors/site/node_identity.hpp"
#include "messages/failure.hpp"
#include "messages/messages.hpp"
#include "schemas/message_catalogue.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <string>
#include <utility>
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

} // namespace

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

namespace {

/// A node that has an identity is called as that says.
caf::error take_name(node_config& config) {
  if (!has_identity_file(config))
    return caf::none;
  const auto read = read_identity_file(identity_file_of(config));
  if (const auto* why = std::get_if<edge_error>(&read))
    return to_caf(*why);
  const auto& who = std::get<own_identity>(read).who();
  if (config.name.empty())
    config.name = who.name;
  if (config.name == who.name)
    return caf::none;
  return fail(error_code::schema_violation,
              "the node is to be called '" + config.name
                  + "', and its identity is of " + text_of(who),
              "", "leave out --name, or have an identity made for that name");
}

} // namespace

caf::error complete_config(node_config& config) {
  auto chosen = resolve_interface(config.address);
  if (auto* why = std::get_if<edge_error>(&chosen))
    return to_caf(*why);
  config.address = std::get<interface_address>(chosen).address;
  if (auto why = take_name(config))
    return why;
  if (config.name.empty())
    config.name = mac_node_name(config.address);
  if (config.cell.empty())
    config.cell = config.name;
  if (auto why = check_words(config))
    return why;
  if (config.require_signed_skills && !has_identity_file(config)
      && config.invitation.empty() && !keeps_site(config))
    return fail(error_code::schema_violation,
                "skills are signed at a site of identities, and this node has "
                "a token",
                "",
                "`roscell site adopt` gives a cell identities; or leave out "
                "--require-signed-skills");
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

namespace {

using granted_sort = skill_grant::sort;

bool may_run_as_others() {
  const auto own = own_capabilities();
  return has_capability(own, "SETUID") && has_capability(own, "SETGID")
         && has_capability(own, "KILL");
}

rlim_t own_limit(__rlimit_resource_t what) {
  rlimit limit{};
  return ::getrlimit(what, &limit) == 0 ? limit.rlim_cur : 0;
}

/// What is in the way of a grant, where skills are processes of this host. An
/// engine has powers of its own.
caf::error lack_for(const skill_grant& x) {
  constexpr int64_t nice_base = 20;
  const auto own = own_capabilities();
  const bool is_nice = has_capability(own, "SYS_NICE");
  const std::string edit = "it is not root; `systemctl edit roscell` may add ";
  switch (x.what) {
  case granted_sort::capability:
    if (has_capability(own, x.name))
      return caf::none;
    return fail(error_code::unauthorized,
                "--grant: this node has no capability " + x.name
                    + " that it could grant to '" + x.skill + "'",
                "",
                edit + "CapabilityBoundingSet= and AmbientCapabilities=CAP_"
                    + x.name);
  case granted_sort::fifo:
  case granted_sort::rr:
    if (is_nice || own_limit(RLIMIT_RTPRIO) >= static_cast<rlim_t>(x.bound))
      return caf::none;
    return fail(error_code::unauthorized,
                "--grant: this node may not give '" + x.skill
                    + "' the real-time priority " + std::to_string(x.bound),
                "", edit + "LimitRTPRIO=" + std::to_string(x.bound));
  case granted_sort::nice:
    if (is_nice
        || own_limit(RLIMIT_NICE) >= static_cast<rlim_t>(nice_base - x.bound))
      return caf::none;
    return fail(error_code::unauthorized,
                "--grant: this node may not give '" + x.skill
                    + "' the nice value " + std::to_string(x.bound),
                "", edit + "LimitNICE=" + std::to_string(x.bound));
  case granted_sort::user:
    break;
  }
  const auto account = find_account(x.name);
  if (may_run_as_others() || (account && account->user == ::geteuid()))
    return caf::none;
  return fail(error_code::unauthorized,
              "--grant: this node may not run '" + x.skill + "' as '" + x.name
                  + "'",
              "",
              edit
                  + "CapabilityBoundingSet= and AmbientCapabilities=CAP_SETUID "
                    "CAP_SETGID CAP_KILL");
}

} // namespace

std::string grant_problem(const std::string& line) {
  const auto read = skill_grants::parse({line});
  if (const auto* why = std::get_if<std::string>(&read))
    return *why;
  for (const auto& x : std::get<skill_grants>(read).all())
    if (x.what == granted_sort::user && !find_account(x.name))
      return "there is no user '" + x.name + "' on this host";
  return {};
}

caf::error check_grants(const node_config& config,
                        const chosen_runtime& runtime) {
  for (const auto& line : config.grants)
    if (const auto why = grant_problem(line); !why.empty())
      return fail(error_code::schema_violation, "--grant: " + why);
  const auto granted = grants_in(config);
  for (const auto& x : granted->all()) {
    if (runtime.socket.empty()) {
      if (auto why = lack_for(x))
        return why;
    } else if (x.what == granted_sort::user) {
      return fail(error_code::schema_violation,
                  "--grant: '" + x.skill + "=user:" + x.name
                      + "': skills are containers here, which run as the "
                        "node's user",
                  "", "leave it out, or give --runtime process");
    }
  }
  return caf::none;
}

shared_skill_grants grants_in(const node_config& config) {
  auto read = skill_grants::parse(config.grants);
  auto* granted = std::get_if<skill_grants>(&read);
  return std::make_shared<skill_grants>(granted != nullptr ? std::move(*granted)
                                                           : skill_grants{});
}

} // namespace roscell
