#include "actors/discovery.hpp"

#include "actors/edge/announcement.hpp"
#include "actors/socket_address.hpp"
#include "messages/failure.hpp"

#include <caf/actor_cast.hpp>

#include <utility>

namespace roscell {

namespace {

using self_pointer = discovery_actor::stateful_pointer<discovery_state>;

/// On a thread of Fast DDS: tells of a coordinator that this version can talk
/// to. Others are told of as an event.
void on_server(const house& context, const discovery_listener_actor& listener,
               const server_sighting& sighting) {
  const auto said = decode(sighting.announcement);
  if (!said || said->role != "coordinator")
    return;
  if (said->protocol_version.substr(0, 2) != "1.") {
    context.tell("coordinator_ignored", said->node,
                 {{"protocol_version", said->protocol_version},
                  {"reason", "this node speaks version 1.0"}});
    return;
  }
  caf::anon_send(listener, coordinator_found{said->cell, said->node,
                                             said->session, said->incarnation});
}

caf::error to_caf(const edge_error& why) {
  return fail(why.code, why.message, "", why.hint);
}

caf::result<caf::ok_atom> find(self_pointer self,
                               const find_coordinator& wish) {
  auto& st = self->state;
  const auto server = parse_socket_address(wish.address);
  if (!server)
    return fail(error_code::unreachable, "'" + wish.address
                                             + "' is not an address like "
                                               "10.0.0.1:11811");
  st.client.reset();
  st.looking_for = wish.address;
  announcement self_said;
  self_said.role = "member";
  self_said.node = st.config.node;
  self_said.uuid = st.config.uuid;
  cell_client_options options;
  options.server_address = server->address;
  options.server_port = server->port;
  options.address = st.config.address;
  options.domain_id = st.config.domain_id;
  options.announcement = encode(self_said);
  cell_client_events events;
  events.on_server =
      [context = st.context,
       listener = caf::actor_cast<discovery_listener_actor>(
           self->current_sender())](const server_sighting& sighting) {
        on_server(context, listener, sighting);
      };
  auto opened = cell_client::open(options, std::move(events));
  if (auto* why = std::get_if<edge_error>(&opened))
    return to_caf(*why);
  st.client = std::get<std::unique_ptr<cell_client>>(std::move(opened));
  return caf::ok_atom_v;
}

void forget(self_pointer self) {
  self->state.client.reset();
  self->state.looking_for.clear();
}

} // namespace

discovery_actor::behavior_type discovery(self_pointer self,
                                         const house& context,
                                         const discovery_config& config) {
  self->state.context = context;
  self->state.config = config;
  return {
      [self](const state_query&) {
        return state_of({{"looking_for", self->state.looking_for}});
      },
      [self](const find_coordinator& wish) { return find(self, wish); },
      [self](const forget_coordinator&) { forget(self); },
  };
}

} // namespace roscell
