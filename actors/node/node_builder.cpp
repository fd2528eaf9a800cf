#include "actors/node/node_builder.hpp"

#include "actors/cell/cell_coordinator.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/edge/host/interfaces.hpp"
#include "actors/edge/host/own_process.hpp"
#include "actors/instances/container_supervisor.hpp"
#include "actors/instances/life/runtime_switch.hpp"
#include "actors/instances/ros2/graph_watch.hpp"
#include "actors/instances/skills/skill_watcher.hpp"
#include "actors/membership/discovery.hpp"
#include "actors/membership/join_diagnoser.hpp"
#include "actors/membership/membership.hpp"
#include "actors/node/config_checks.hpp"
#include "actors/node/node.hpp"
#include "actors/node/node_agent.hpp"
#include "actors/node/node_runtime.hpp"
#include "actors/node/resource_probe.hpp"
#include "actors/node/state_store.hpp"
#include "actors/placement/scheduler.hpp"
#include "actors/placement/searcher.hpp"
#include "actors/requests/handler_pipeline.hpp"
#include "actors/requests/handlers/insight.hpp"
#include "actors/requests/request_router.hpp"
#include "actors/requests/rest.hpp"
#include "actors/session/registration_client.hpp"
#include "actors/session/session_connector.hpp"
#include "actors/site/node_identity.hpp"
#include "messages/failure.hpp"

#include <system_error>
#include <utility>

namespace roscell {

node_builder::node_builder(caf::actor_system& system, node_config config,
                           node_data data, actor_context context,
                           node_history_actor history,
                           std::shared_ptr<node_edges> edges,
                           capacity_bound bound, chosen_runtime runtime,
                           shared_skill_catalogue catalogue,
                           node_additions additions)
    : system_(system), data_(std::move(data)), history_(std::move(history)),
      bound_(std::move(bound)), runtime_(std::move(runtime)),
      additions_(std::move(additions)) {
  parts_.config = std::move(config);
  parts_.skills = std::make_shared<current_skills>(std::move(catalogue));
  parts_.context = std::move(context);
  parts_.edges = std::move(edges);
  parts_.lock = data_.lock;
  parts_.database = data_.database;
  parts_.services = std::make_shared<node_services>();
  parts_.services->context = parts_.context;
  parts_.services->name = parts_.config.name;
  parts_.services->graph = parts_.edges->graph;
  parts_.services->check_host = one_at_a_time(additions_.check_host);
  parts_.identity = data_.identity;
  parts_.limits = runtime_.limits;
  parts_.identity.name = parts_.config.name;
  parts_.identity.address = parts_.edges->http_address;
}

void node_builder::build(running_node& result) {
  add(parts_.context.events);
  parts_.skills->get()->publish_problems(parts_.context, {});
  start_images();
  start_secrets();
  start_site();
  start_supervision();
  start_builds();
  if (parts_.config.coordinator)
    start_coordination();
  else
    start_membership();
  start_watching();
  start_measuring();
  start_prober();
  start_execs();
  start_requests();
  result.actor = parts_.services->node;
  result.router = parts_.router;
}

std::function<runtime_actor(container_listener_actor)>
node_builder::make_runtime() {
  auto programs = runtime_factory(system_, parts_.context, parts_.config,
                                  runtime_, data_.identity.uuid,
                                  *parts_.edges->io, history_, images_);
  if (additions_.actor_skills.empty())
    return programs;
  return [&system = system_, context = parts_.context, programs,
          actors = additions_.make_actor_runtime](
             const container_listener_actor& listener) {
    return spawn(system, context, runtime_switch, programs(listener),
                 actors(context, listener), listener);
  };
}

void node_builder::start_supervision() {
  auto& config = parts_.config;
  store_ = start_blocking(state_store, parts_.context, data_.database);
  container_supervisor_config supervision;
  supervision.context = parts_.context;
  supervision.node = config.name;
  supervision.skills = parts_.skills;
  supervision.make_runtime = make_runtime();
  supervision.builds_images = !runtime_.socket.empty();
  supervision.write_environment_update =
      make_environment_writer(config, runtime_);
  supervision.write_parameters = make_parameter_writer(config, runtime_);
  supervision.answer_request = make_request_answerer(config, runtime_);
  supervision.store = store_;
  supervision.history = history_;
  supervision.graph = start(graph_watch, parts_.edges->graph);
  supervision.address = config.address;
  supervision.restored = data_.instances;
  supervision.started_at = data_.started_at;
  supervision.started_in = data_.started_in;
  supervision.boot = this_boot();
  supervision.strays = data_.strays;
  supervision.may_be_lost = !config.coordinator;
  supervision.learns_place = !config.coordinator;
  supervision.environment = parts_.edges->environment;
  supervision.grants = grants_in(config);
  supervision.secrets = parts_.services->secrets;
  parts_.services->supervisor = start(container_supervisor, supervision);
  resource_probe_config probing;
  probing.host.data_dir = config.data_dir.string();
  probing.bound = bound_;
  const auto probe = start_blocking(resource_probe, probing);
  mark_samples_at_heartbeats(*parts_.edges, probe);
  parts_.agent =
      start(node_agent,
            node_agent_config{config.name, config.labels, config.devices,
                              parts_.services->supervisor, probe,
                              config.cpu_floor, config.grants, secret_names_});
}

void node_builder::start_coordination() {
  const auto& config = parts_.config;
  coordinator_setup setup;
  setup.cell = config.cell;
  setup.discovery_server = parts_.edges->discovery_server;
  setup.graph = parts_.edges->graph;
  setup.incarnation = data_.incarnation;
  setup.cell_uuid = data_.cell_uuid;
  setup.self = parts_.identity;
  const auto skills = parts_.skills->get();
  setup.skills = skills->skills();
  setup.refused_skills = skills->published_problems();
  setup.agent = parts_.agent;
  setup.keeper = parts_.services->keeper;
  setup.build_key = new_build_key();
  parts_.edges->permits->use_key(setup.build_key);
  setup.builds = data_.builds;
  setup.remains = data_.remains;
  setup.supervisor = parts_.services->supervisor;
  setup.store = store_;
  setup.tasks = data_.tasks;
  setup.members = data_.members;
  setup.transfers = data_.transfers;
  setup.history = data_.history;
  setup.drains = data_.drains;
  setup.sets = data_.sets;
  setup.server_id = parts_.edges->server_id;
  setup.rebalance = config.rebalance;
  setup.ros2_set_parameters = config.ros2_set_parameters;
  setup.require_signed_skills = config.require_signed_skills;
  if (const auto& identity = data_.site.identity())
    setup.check_signature = signature_check(identity);
  setup.ros_domain_id = config.ros_domain_id;
  setup.environment = parts_.edges->environment;
  setup.searches = std::make_shared<search_guard>();
  setup.scheduler = start_scheduler(setup.searches);
  setup.discovery = start_discovery();
  setup.connector = start_connector();
  setup.registration =
      start(registration_client,
            registration_client_config{parts_.edges->io.get(), data_.site});
  parts_.services->scheduler = setup.scheduler;
  auto coordinator = start(cell_coordinator, parts_.context, setup);
  parts_.services->coordinator = coordinator;
  caf::anon_send(parts_.services->supervisor, listen_to_instances{coordinator});
  admit_sessions(
      system_, parts_.context, *parts_.edges,
      {config.name, parts_.identity.uuid, config.cell, data_.incarnation},
      data_.site, coordinator);
}

scheduler_actor
node_builder::start_scheduler(std::shared_ptr<search_guard> guard) {
  auto make = [&system = system_, context = parts_.context](
                  auto searches, const scheduler_actor& owner) {
    return spawn<caf::detached>(system, context, searcher, context, searches,
                                owner);
  };
  return start(scheduler, scheduler_config{std::move(guard), make});
}

discovery_actor node_builder::start_discovery() {
  const auto& config = parts_.config;
  return start_blocking(
      discovery, parts_.context,
      discovery_config{config.address, config.name, config.public_domain_id,
                       config.peers, config.discovery_port, parts_.edges->graph,
                       parts_.edges->numbers, parts_.edges->discovery.get()});
}

session_connector_actor node_builder::start_connector() {
  return start(session_connector, parts_.context,
               connector_parts{parts_.edges->io.get(),
                               parts_.edges->sockets.heartbeat.get(),
                               data_.site, parts_.services->site});
}

membership_config node_builder::membership_setup() const {
  const auto& config = parts_.config;
  membership_config result;
  result.identity = parts_.identity;
  const auto skills = parts_.skills->get();
  result.skills = skills->skills();
  result.refused_skills = skills->published_problems();
  result.restored = data_.membership;
  result.configured = config.wait ? "wait" : config.join;
  result.site = data_.site;
  result.public_domain = config.public_domain_id;
  result.claim_address = [at = config.address] { claim_address(at); };
  return result;
}

void node_builder::start_membership() {
  const auto& config = parts_.config;
  membership_parts with;
  with.discovery = start_discovery();
  with.connector = start_connector();
  with.agent = parts_.agent;
  with.supervisor = parts_.services->supervisor;
  with.store = store_;
  with.permits = parts_.edges->permits;
  with.keeper = parts_.services->keeper;
  with.diagnoser =
      start(join_diagnoser, join_diagnoser_config{parts_.edges->io.get(),
                                                  config.address, data_.site});
  const auto how = membership_setup();
  auto member = start(membership, parts_.context, with, how);
  parts_.services->membership = member;
  caf::anon_send(parts_.services->supervisor, listen_to_instances{member});
  if (takes_up_earlier_cell(how) || config.wait)
    return;
  if (config.join.empty())
    caf::anon_send(member, seek_cell{});
  else
    caf::anon_send(member, join_cell{config.join});
}

void node_builder::start_watching() {
  const auto& services = *parts_.services;
  skill_watcher_config with;
  with.context = parts_.context;
  with.node = parts_.config.name;
  with.places = skill_places_of(parts_.config);
  with.skills = parts_.skills;
  if (services.coordinator)
    with.listener = services.coordinator;
  else
    with.listener = services.membership;
  with.io = parts_.edges->io->core();
  parts_.watcher = start_blocking(skill_watcher, with);
  caf::anon_send(parts_.agent, serve_builds{services.keeper, fetcher_,
                                            parts_.watcher, images_});
  if (!images_)
    return;
  image_broker_actor broker;
  if (services.coordinator)
    broker = services.coordinator;
  else
    broker = services.membership;
  caf::anon_send(images_, serve_images{broker, services.keeper, fetcher_});
}

void node_builder::start_requests() {
  const auto registry = std::make_shared<const request_registry>(
      make_registry(parts_.config.coordinator));
  parts_.router = start(request_router, registry,
                        std::shared_ptr<const node_services>(parts_.services));
  caf::anon_send(parts_.services->supervisor, use_router{parts_.router});
  if (const auto& coordinator = parts_.services->coordinator)
    caf::anon_send(coordinator, use_router{parts_.router});
  if (const auto& membership = parts_.services->membership)
    caf::anon_send(membership, use_router{parts_.router});
  parts_.services->node = spawn(system_, parts_.context, node, parts_);
  parts_.edges->handler->set(make_rest_handler(
      system_, {parts_.context, parts_.router, parts_.services, pages()}));
}

std::shared_ptr<const web_pages> node_builder::pages() const {
  return parts_.config.coordinator
             ? std::make_shared<const web_pages>(parts_.config.pages)
             : nullptr;
}

} // namespace roscell
