#include "actors/session/session_connector.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/session/wire_session.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

using session_connector_self =
    session_connector_actor::stateful_pointer<session_connector_state>;

/// On the io thread: turns the outcome of an attempt into a message.
session_settled settle(caf::actor_system& system, const house& context,
                       beat_socket& beats, uint64_t attempt, uint16_t beat_port,
                       session_result result) {
  if (auto* why = std::get_if<edge_error>(&result))
    return {attempt, {}, {why->code, why->message, "", why->hint, ""}};
  auto& session = std::get<established_session>(result);
  session_opened opened;
  opened.cell = session.peer.cell;
  opened.coordinator = session.peer.node;
  opened.incarnation = session.peer.number;
  opened.session =
      spawn_session(system, context, beats, std::move(session), beat_port);
  return {attempt, std::move(opened), {}};
}

caf::result<session_opened> open(session_connector_self self,
                                 const open_session& wish) {
  auto& st = self->state;
  const auto place = parse_socket_address(wish.address);
  if (!place)
    return fail(error_code::unreachable,
                "'" + wish.address + "' is not an address like 10.0.0.1:8420");
  const auto attempt = ++st.attempts;
  auto promise = self->make_response_promise<session_opened>();
  st.pending.emplace(attempt, promise);
  connect_session(*st.parts.io, {place->address, place->port, "", wish.uuid},
                  {wish.self.name, wish.self.uuid, wish.self.epoch,
                   wish.role == node_role::coordinator
                       ? std::string{to_word(wish.role)}
                       : std::string{}},
                  st.parts.site_token, {},
                  [&system = self->system(), context = st.context,
                   beats = st.parts.beats, attempt, port = place->port,
                   me = session_connector_actor{self}](session_result result) {
                    caf::anon_send(me, settle(system, context, *beats, attempt,
                                              port, std::move(result)));
                  });
  return promise;
}

void on_settled(session_connector_self self, const session_settled& fact) {
  auto i = self->state.pending.find(fact.attempt);
  if (i == self->state.pending.end())
    return;
  auto promise = std::move(i->second);
  self->state.pending.erase(i);
  if (fact.opened.session)
    promise.deliver(fact.opened);
  else
    promise.deliver(to_error(fact.problem));
}

} // namespace

session_connector_actor::behavior_type
session_connector(session_connector_self self, const house& context,
                  const connector_parts& parts) {
  self->state.context = context;
  self->state.parts = parts;
  return {
      [self](const state_query&) {
        return state_of({{"attempts", self->state.attempts},
                         {"pending", self->state.pending.size()}});
      },
      [self](const open_session& wish) { return open(self, wish); },
      [self](const session_settled& fact) { on_settled(self, fact); },
  };
}

} // namespace roscell
