#include "actors/node/node_edges.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/http/http_target.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/node/cell_claim.hpp"
#include "actors/node/limits.hpp"
#include "actors/node/refusal_pace.hpp"
#include "actors/session/wire_session.hpp"
#include "dds/server_addresses.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <memory>
#include <utility>

namespace roscell {

namespace {

std::string socket_path(const node_config& config) {
  return (config.socket.empty() ? config.data_dir / "node.sock" : config.socket)
      .string();
}

std::string again(size_t times) {
  return times > 1 ? ", and so " + std::to_string(times - 1)
                         + " times since the last such event"
                   : std::string{};
}

std::function<void(const std::string&, const distrusted&)>
report_distrust(const actor_context& context) {
  const auto pace = std::make_shared<refusal_pace>();
  return [context, pace](const std::string& address, const distrusted& why) {
    const auto times = pace->count(address, std::chrono::steady_clock::now());
    if (times > 0)
      context.publish_event(events::session_refused, address,
                            {{"code", error_code::unauthorized},
                             {"message", why.text + again(times)}});
  };
}

caf::error open_http(const node_config& config, const node_data& data,
                     const actor_context& context, node_edges& edges) {
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
  options.permits = [permits = edges.permits](const std::string& path,
                                              std::string_view token,
                                              const std::string& from) {
    return permits->allows(path, token, from);
  };
  options.identity = data.site.identity();
  options.on_distrusted = report_distrust(context);
  heartbeat_socket_options heartbeats;
  heartbeats.site = data.site;
  auto opened =
      open_node_sockets(*edges.io, std::move(options), std::move(heartbeats));
  if (auto* why = std::get_if<edge_error>(&opened))
    return to_caf(*why);
  edges.sockets = std::get<node_sockets>(std::move(opened));
  edges.http_address =
      config.address + ":" + std::to_string(edges.sockets.http->port());
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

caf::expected<std::shared_ptr<node_edges>>
open_edges(const node_config& config, const node_data& data,
           const actor_context& context) {
  auto edges = std::make_shared<node_edges>();
  edges->io = std::make_unique<io_thread>([context](const std::string& text) {
    context.publish_event(events::edge_problem, "", {{"message", text}});
  });
  edges->numbers = std::make_shared<number_reserve>(
      config.data_dir / "discovery_numbers",
      [context](const std::string& why) {
        context.publish_event(events::edge_problem, "", {{"message", why}});
      },
      data.is_new ? number_reserve::former_lives::few
                  : number_reserve::former_lives::many);
  if (auto why = open_http(config, data, context, *edges))
    return why;
  if (!config.coordinator)
    return edges;
  const auto id = claim_cell(config, data, *edges, context);
  if (!id)
    return id.error();
  edges->server_id = *id;
  if (auto why = open_discovery(config, data, *edges))
    return why;
  return edges;
}

void admit_sessions(caf::actor_system& system, const actor_context& context,
                    node_edges& edges, const acceptor_identity& identity,
                    const site_secret& site,
                    const cell_coordinator_actor& coordinator) {
  session_acceptor acceptor;
  acceptor.identity = identity;
  acceptor.site = site;
  acceptor.on_session = [&system, context,
                         heartbeats = edges.sockets.heartbeat.get(),
                         known = edges.known,
                         coordinator](established_session session) {
    node_identity peer;
    peer.name = session.peer.node;
    peer.uuid = session.peer.uuid;
    peer.epoch = session.peer.number;
    peer.address = session.peer.address;
    known->add(peer.name, peer.uuid);
    const auto role = session.peer.role == to_word(node_role::coordinator)
                          ? node_role::coordinator
                          : node_role::primary;
    auto actor =
        spawn_session(system, context, *heartbeats, std::move(session), 0);
    caf::anon_send(coordinator, session_admitted{actor, std::move(peer), role});
  };
  acceptor.on_refused = [context](const std::string& address,
                                  const edge_error& why) {
    context.publish_event(events::session_refused, address,
                          {{"code", why.code}, {"message", why.message}});
  };
  edges.sockets.http->accept_sessions(std::move(acceptor));
}

void mark_samples_at_heartbeats(node_edges& edges,
                                const resource_probe_actor& probe) {
  using clock = std::chrono::steady_clock;
  edges.sockets.heartbeat->watch([probe, last = clock::time_point{}]() mutable {
    const auto now = clock::now();
    if (now - last < limits::resource::mark_distance)
      return;
    last = now;
    caf::anon_send(probe, mark_sample{});
  });
}

} // namespace roscell
