#include "actors/node/node_edges.hpp"

#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/dds/site_survey.hpp"
#include "actors/edge/http/http_paths.hpp"
#include "actors/edge/io/name_lookup.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/session/address_scout.hpp"
#include "actors/house/edge_failure.hpp"
#include "actors/house/limits.hpp"
#include "actors/session/wire_session.hpp"
#include "dds/server_ids.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <future>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

std::string socket_path(const node_config& config) {
  return (config.socket.empty() ? config.data_dir / "node.sock" : config.socket)
      .string();
}

caf::error open_http(const node_config& config, const node_data& data,
                     node_edges& edges) {
  http_server_options options;
  options.address = config.address;
  options.port = config.http_port;
  options.socket_path = edges.socket_path = socket_path(config);
  options.token = data.token;
  options.public_paths.insert(options.public_paths.end(),
                              {registration_path, hello_path});
  options.handler = [handler = edges.handler](http_request request,
                                              const responder& answer) {
    (*handler)(std::move(request), answer);
  };
  beat_socket_options beats;
  beats.reach_key = reach_key(data.site_token);
  auto opened =
      open_node_sockets(*edges.io, std::move(options), std::move(beats));
  if (auto* why = std::get_if<edge_error>(&opened))
    return to_caf(*why);
  edges.sockets = std::get<node_sockets>(std::move(opened));
  edges.http_address =
      config.address + ":" + std::to_string(edges.sockets.http->port());
  return caf::none;
}

caf::error name_in_use(const announcement& other) {
  return fail(error_code::conflict,
              "the cell name '" + other.cell + "' is in use: node '"
                  + other.node + "' at " + other.session + " coordinates it",
              "", "choose another --cell, or take it over with --force");
}

/// Whether what is announced with this node's own UUID is somebody who lives:
/// it answers, as a coordinator of this cell. What it was itself, at an address
/// that it has left, does not.
bool lives_elsewhere(const announcement& other, const std::string& cell,
                     node_edges& edges) {
  const auto at = parse_socket_address(other.session);
  if (!at || other.session == edges.http_address)
    return false;
  auto heard = std::make_shared<std::promise<scouted_port>>();
  auto answer = heard->get_future();
  ask_for_hello(edges.io->core(), *at,
                [heard](scouted_port x) { heard->set_value(std::move(x)); });
  const auto seen = answer.get();
  return !seen.hello.empty() && seen.hello[0].role == node_role::coordinator
         && seen.hello[0].cell == cell;
}

caf::error is_a_copy(const announcement& other) {
  return fail(
      error_code::conflict,
      "this coordinator runs at " + other.session
          + " already: the data directory is a copy",
      "",
      "stop that one to go on with its cell here, or start this one once "
      "with --new-identity and another --cell: then it is another cell");
}

/// Looks at the coordinators that are there: cell names and server ids in use.
caf::error survey(const node_config& config, const node_data& data,
                  node_edges& edges) {
  presence_options options;
  options.address = config.address;
  options.domain_id = config.public_domain_id;
  // Names that do not resolve yet are looked up again when the node announces
  // itself, which tells of them.
  options.peers =
      await_hosts(config.peers, limits::discovery::peer_names).addresses;
  const auto claims_our_name = [&](const announcement& x) {
    return x.role == "coordinator" && x.cell == config.cell
           && x.uuid != data.identity.uuid;
  };
  auto seen = survey_site(options, limits::discovery::survey, claims_our_name);
  if (auto* why = std::get_if<edge_error>(&seen))
    return to_caf(*why);
  std::set<int64_t> used;
  for (const auto& x : std::get<std::vector<announcement>>(seen)) {
    if (claims_our_name(x) && !config.force)
      return name_in_use(x);
    if (x.role == "coordinator" && x.uuid == data.identity.uuid
        && lives_elsewhere(x, config.cell, edges))
      return is_a_copy(x);
    if (x.role == "coordinator" && x.uuid != data.identity.uuid)
      used.insert(x.server);
  }
  while (edges.server_id < UINT8_MAX && used.count(edges.server_id) > 0)
    ++edges.server_id;
  edges.server_id = config.server_id.value_or(edges.server_id);
  return caf::none;
}

caf::error open_discovery(const node_config& config, const node_data& data,
                          node_edges& edges) {
  announcement said;
  said.role = "coordinator";
  said.node = config.name;
  said.cell = config.cell;
  said.session = edges.http_address;
  said.uuid = data.identity.uuid;
  said.incarnation = data.incarnation;
  cell_server_options options;
  options.address = config.address;
  options.port = config.discovery_port;
  options.server_id = edges.server_id;
  options.domain_id = config.ros_domain_id;
  options.announcement = encode(said);
  options.graph = edges.graph;
  options.numbers = edges.numbers;
  auto opened = cell_server::open(options);
  if (auto* why = std::get_if<edge_error>(&opened))
    return to_caf(*why);
  edges.discovery = std::get<std::unique_ptr<cell_server>>(std::move(opened));
  edges.discovery_server =
      config.address + ":" + std::to_string(edges.discovery->port());
  edges.environment = {
      {"ROS_DOMAIN_ID", std::to_string(config.ros_domain_id)},
      {"ROS_DISCOVERY_SERVER",
       ros_discovery_server(edges.server_id, edges.discovery_server)}};
  return caf::none;
}

} // namespace

void late_handler::set(http_handler handler) {
  std::lock_guard guard{mutex_};
  handler_ = std::move(handler);
}

void late_handler::operator()(http_request request,
                              const responder& answer) const {
  http_handler handler;
  {
    std::lock_guard guard{mutex_};
    handler = handler_;
  }
  if (handler)
    handler(std::move(request), answer);
  else
    answer.error(503, error_code::conflict, "the node is still starting");
}

caf::expected<std::shared_ptr<node_edges>> open_edges(const node_config& config,
                                                      const node_data& data,
                                                      const house& context) {
  auto edges = std::make_shared<node_edges>();
  edges->io = std::make_unique<io_thread>([context](const std::string& text) {
    context.tell("edge_trouble", "", {{"message", text}});
  });
  edges->numbers = std::make_shared<number_reserve>(
      config.data_dir / "discovery_numbers",
      [context](const std::string& why) {
        context.tell("edge_trouble", "", {{"message", why}});
      },
      data.is_new ? number_reserve::former_lives::few
                  : number_reserve::former_lives::many);
  if (auto why = open_http(config, data, *edges))
    return why;
  if (!config.coordinator)
    return edges;
  if (auto why = survey(config, data, *edges))
    return why;
  if (auto why = open_discovery(config, data, *edges))
    return why;
  return edges;
}

void admit_sessions(caf::actor_system& system, const house& context,
                    node_edges& edges, const acceptor_identity& identity,
                    const std::string& site_token,
                    const cell_coordinator_actor& coordinator) {
  session_acceptor acceptor;
  acceptor.identity = identity;
  acceptor.token = site_token;
  acceptor.on_session = [&system, context, beats = edges.sockets.beat.get(),
                         coordinator](established_session session) {
    node_identity peer;
    peer.name = session.peer.node;
    peer.uuid = session.peer.uuid;
    peer.epoch = session.peer.number;
    peer.address = session.peer.address;
    const auto role = session.peer.role == to_word(node_role::coordinator)
                          ? node_role::coordinator
                          : node_role::primary;
    auto actor = spawn_session(system, context, *beats, std::move(session), 0);
    caf::anon_send(coordinator, session_admitted{actor, std::move(peer), role});
  };
  acceptor.on_refused = [context](const std::string& address,
                                  const edge_error& why) {
    context.tell("session_refused", address,
                 {{"code", why.code}, {"message", why.message}});
  };
  edges.sockets.http->accept_sessions(std::move(acceptor));
}

void mark_samples_at_beats(node_edges& edges,
                           const resource_probe_actor& probe) {
  using clock = std::chrono::steady_clock;
  edges.sockets.beat->watch([probe, last = clock::time_point{}]() mutable {
    const auto now = clock::now();
    if (now - last < limits::resource::mark_distance)
      return;
    last = now;
    caf::anon_send(probe, mark_sample{});
  });
}

} // namespace roscell
