#include "actors/membership/discovery.hpp"

#include "actors/core/edge_failure.hpp"
#include "actors/edge/dds/announcement.hpp"
#include "actors/edge/io/plain_text.hpp"
#include "actors/edge/io/socket_address.hpp"
#include "actors/membership/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <caf/actor_cast.hpp>

#include <utility>

namespace roscell {

namespace {

/// Whether this version can talk to who announces this. Coordinators of
/// another version are told of as an event.
bool speaks_with(const actor_context& context, const announcement& said) {
  if (said.protocol_version.substr(0, 2) == "1.")
    return true;
  if (said.role == "coordinator")
    context.publish_event(events::coordinator_ignored, said.node,
                          {{"protocol_version", said.protocol_version},
                           {"reason", "this node speaks version 1.0"}});
  return false;
}

/// Whether an unauthenticated peer's words can be what they claim to be: they
/// end up in replies, which have schemas.
bool is_sound(const announcement& said) {
  const bool coordinates = said.role == "coordinator";
  const bool free = said.role == "independent" || said.role == "orphaned";
  if (!coordinates && !free)
    return false;
  if (!is_name(said.node) || !is_uuid(said.uuid)
      || !parse_socket_address(said.session))
    return false;
  return coordinates
             ? is_name(said.cell) && parse_socket_address(said.discovery)
             : said.cell.empty() || is_name(said.cell);
}

/// On the thread of the inquiry: tells of the coordinator behind a server.
void on_server(const actor_context& context,
               const discovery_listener_actor& listener,
               const server_sighting& sighting) {
  const auto said = decode(sighting.announcement);
  if (!said || said->role != "coordinator" || !speaks_with(context, *said))
    return;
  caf::anon_send(listener, coordinator_found{said->cell, said->node,
                                             said->session, said->incarnation});
}

caf::result<caf::ok_atom> find(discovery_self self,
                               const find_coordinator& request) {
  auto& st = self->state;
  const auto server = parse_socket_address(request.address);
  if (!server)
    return fail(error_code::unreachable, "'" + request.address
                                             + "' is not an address like "
                                               "10.0.0.1:11811");
  st.inquiry.reset();
  st.looking_for = request.address;
  server_inquiry_options options;
  options.server_address = server->address;
  options.server_port = server->port;
  options.address = st.config.address;
  auto opened = server_inquiry::open(
      options, [context = st.context,
                listener = caf::actor_cast<discovery_listener_actor>(
                    self->current_sender())](const server_sighting& sighting) {
        on_server(context, listener, sighting);
      });
  if (auto* why = std::get_if<edge_error>(&opened))
    return to_caf(*why);
  st.inquiry = std::get<std::unique_ptr<server_inquiry>>(std::move(opened));
  return caf::ok_atom_v;
}

void forget(discovery_self self) {
  self->state.inquiry.reset();
  self->state.looking_for.clear();
}

node_presence to_presence(const announcement& said) {
  return {said.role,        said.node,     said.uuid,    said.epoch,
          said.incarnation, said.cell,     said.session, said.discovery,
          said.server,      said.cell_uuid};
}

announcement to_announcement(const node_presence& x) {
  announcement result;
  result.role = x.role;
  result.node = x.name;
  result.uuid = x.uuid;
  result.epoch = x.epoch;
  result.incarnation = x.incarnation;
  result.cell = x.cell;
  result.session = x.address;
  result.discovery = x.discovery_server;
  result.server = x.server_id;
  result.cell_uuid = x.cell_uuid;
  return result;
}

/// The peers in numbers. A name that does not resolve is told of once, and
/// looked up again later: who is not there yet may come.
std::vector<std::string> find_peers(discovery_self self) {
  auto& st = self->state;
  auto found = await_hosts(st.config.peers, limits::discovery::peer_names);
  if (found.problem.empty()) {
    st.pause.reset();
  } else {
    if (st.unresolved != found.problem)
      st.context.publish_event(events::edge_problem, st.config.node,
                               {{"message", "--peer: " + found.problem}});
    st.timer.set(self, self->clock().now() + st.pause.next());
  }
  st.unresolved = std::move(found.problem);
  return std::move(found.addresses);
}

/// Opens the public participant. Who cannot announce itself goes on without:
/// it can still join by an address.
void appear(discovery_self self, std::vector<std::string> peers) {
  auto& st = self->state;
  const auto& listener = st.listener;
  presence_options options;
  options.address = st.config.address;
  options.domain_id = st.config.public_domain_id;
  options.peers = std::move(peers);
  st.peers = options.peers;
  options.announcement = st.announced;
  presence_events events;
  events.on_seen = [context = st.context, listener](const announcement& said) {
    if (is_sound(said) && speaks_with(context, said))
      caf::anon_send(listener, presence_seen{to_presence(said)});
  };
  events.on_gone = [listener](const announcement& said) {
    caf::anon_send(listener, presence_gone{to_presence(said)});
  };
  auto opened = public_presence::open(options, std::move(events));
  if (auto* why = std::get_if<edge_error>(&opened))
    return st.context.publish_event(events::edge_problem, st.config.node,
                                    {{"message", why->message}});
  st.presence = std::get<std::unique_ptr<public_presence>>(std::move(opened));
}

void announce(discovery_self self, const announce_presence& request) {
  auto& st = self->state;
  st.announced = encode(to_announcement(request.self));
  if (st.presence) {
    st.presence->update(st.announced);
  } else {
    st.listener =
        caf::actor_cast<presence_listener_actor>(self->current_sender());
    appear(self, find_peers(self));
  }
}

/// Looks the peers' names up again. A participant keeps the peers that it was
/// made with, so new ones need another.
void on_tick(discovery_self self, uint64_t number) {
  auto& st = self->state;
  if (!st.timer.rings(number) || !st.presence)
    return;
  auto peers = find_peers(self);
  if (peers == st.peers)
    return;
  st.presence.reset();
  appear(self, std::move(peers));
}

void withdraw(discovery_self self) {
  self->state.presence.reset();
  self->state.announced.clear();
}

} // namespace

discovery_actor::behavior_type discovery(discovery_self self,
                                         const actor_context& context,
                                         const discovery_config& config) {
  self->state.context = context;
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of({{"looking_for", self->state.looking_for},
                         {"serves", self->state.server != nullptr},
                         {"announced", self->state.announced}});
      },
      [self](const find_coordinator& request) { return find(self, request); },
      [self](const forget_coordinator&) { forget(self); },
      [self](const serve_programs& request) {
        return serve_programs_of_node(self, request);
      },
      [self](const stop_serving&) { self->state.server.reset(); },
      [self](const follow_server& request) {
        follow_another_server(self, request);
        return caf::ok_atom_v;
      },
      [self](const announce_presence& request) { announce(self, request); },
      [self](const withdraw_presence&) { withdraw(self); },
      [self](caf::tick_atom, uint64_t number) { on_tick(self, number); },
  };
}

} // namespace roscell
