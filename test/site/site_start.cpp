#include "test/site/site_start.hpp"

#include "actors/instances/container_supervisor.hpp"
#include "actors/node/node_agent.hpp"
#include "actors/requests/handler_pipeline.hpp"
#include "actors/requests/request_router.hpp"
#include "test/actors/fakes/planner.hpp"
#include "test/site/site_skills.hpp"

#include <caf/actor_cast.hpp>

#include <memory>
#include <utility>

namespace roscell::test {

namespace {

template <class Handle>
Handle part(const site_party& x) {
  return caf::actor_cast<Handle>(x.edge);
}

std::string record(const site_party& x, const std::string& table,
                   const std::string& key) {
  const auto records = x.disk.find(table);
  if (records == x.disk.end())
    return {};
  const auto i = records->second.find(key);
  return i == records->second.end() ? std::string{} : i->second;
}

template <class T>
std::vector<T> load(const site_party& x, const std::string& table) {
  std::vector<T> result;
  const auto records = x.disk.find(table);
  if (records != x.disk.end())
    for (const auto& [key, value] : records->second)
      result.push_back(json::parse(value).template get<T>());
  return result;
}

node_identity identity_on_disk(const site_party& x) {
  const auto known = record(x, "identity", "node");
  auto result =
      known.empty() ? node_identity{} : json::parse(known).get<node_identity>();
  result.name = x.name;
  result.uuid = x.uuid;
  result.address = x.address;
  return result;
}

membership_config membership_setup(const site_party& x) {
  membership_config result;
  result.identity = identity_on_disk(x);
  result.skills = site_skills()->skills();
  result.configured = x.configured;
  result.site = site_token;
  if (const auto known = record(x, "identity", "membership"); !known.empty())
    result.restored = json::parse(known).get<membership_record>();
  return result;
}

void start_supervision(site& place, site_party& x) {
  container_supervisor_config config;
  config.context = x.context;
  config.node = x.name;
  config.skills = std::make_shared<current_skills>(site_skills());
  config.may_be_lost = !x.coordinates;
  config.make_runtime = [&x](const container_listener_actor& listener) {
    x.listener = listener;
    return part<runtime_actor>(x);
  };
  config.store = part<state_store_actor>(x);
  config.restored = load<instance_row>(x, "instances");
  x.supervisor =
      spawn(place.time.system, x.context, container_supervisor, config);
  node_agent_config agent;
  agent.node = x.name;
  agent.labels = {{"is", x.name},
                  {"coordinates", x.coordinates ? "yes" : "no"}};
  agent.supervisor = x.supervisor;
  agent.probe = part<resource_probe_actor>(x);
  x.agent = spawn(place.time.system, x.context, node_agent, agent);
}

void start_membership(site& place, site_party& x) {
  membership_parts parts;
  parts.discovery = part<discovery_actor>(x);
  parts.connector = part<session_connector_actor>(x);
  parts.agent = x.agent;
  parts.supervisor = x.supervisor;
  parts.store = part<state_store_actor>(x);
  parts.diagnoser = part<join_diagnoser_actor>(x);
  const auto config = membership_setup(x);
  x.membership =
      spawn(place.time.system, x.context, membership, x.context, parts, config);
  caf::anon_send(x.supervisor, listen_to_instances{x.membership});
  if (takes_up_earlier_cell(config) || x.configured == "wait")
    return;
  if (x.configured.empty())
    caf::anon_send(x.membership, seek_cell{});
  else
    caf::anon_send(x.membership, join_cell{x.configured});
}

coordinator_setup setup_of(site_party& x) {
  const auto known = record(x, "identity", "incarnation");
  coordinator_setup setup;
  setup.incarnation = known.empty() ? 1 : std::stoll(known) + 1;
  x.disk["identity"]["incarnation"] = std::to_string(setup.incarnation);
  setup.cell = x.cell;
  setup.cell_uuid = "ce-" + x.uuid;
  setup.discovery_server = x.discovery_server;
  setup.self = identity_on_disk(x);
  setup.skills = site_skills()->skills();
  setup.agent = x.agent;
  setup.supervisor = x.supervisor;
  setup.store = part<state_store_actor>(x);
  setup.discovery = part<discovery_actor>(x);
  setup.connector = part<session_connector_actor>(x);
  setup.registration = part<registration_client_actor>(x);
  setup.tasks = load<task_record>(x, "tasks");
  setup.members = load<member_record>(x, "members");
  setup.transfers = load<transfer_row>(x, "transfers");
  setup.history = load<history_record>(x, "history");
  setup.drains = load<drain_record>(x, "drains");
  return setup;
}

void start_coordinator(site& place, site_party& x) {
  auto& system = place.time.system;
  auto setup = setup_of(x);
  setup.searches = std::make_shared<search_guard>();
  x.planner = spawn_planner(system, x.context, setup.searches);
  setup.scheduler = x.planner;
  x.coordinator = spawn(system, x.context, cell_coordinator, x.context, setup);
  caf::anon_send(x.supervisor, listen_to_instances{x.coordinator});
  auto services = std::make_shared<node_services>();
  services->context = x.context;
  services->coordinator = x.coordinator;
  services->scheduler = x.planner;
  services->supervisor = x.supervisor;
  x.router =
      spawn(system, x.context, request_router,
            std::make_shared<const request_registry>(make_registry(true)),
            std::shared_ptr<const node_services>(services));
}

} // namespace

void start_parts(site& place, site_party& x) {
  start_supervision(place, x);
  if (x.coordinates)
    start_coordinator(place, x);
  else
    start_membership(place, x);
}

} // namespace roscell::test
