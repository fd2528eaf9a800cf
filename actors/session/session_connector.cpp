#include "actors/session/session_connector.hpp"

#include "actors/edge/io/socket_address.hpp"
#include "actors/edge/session/session_link.hpp"
#include "actors/edge/session/site_token.hpp"
#include "actors/edge/trust/site_identity.hpp"
#include "actors/session/wire_session.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

using session_connector_self =
    session_connector_actor::stateful_pointer<session_connector_state>;

/// Why there is no session, with what this node's side can do about it.
failure refusal_of(const edge_error& why, const site_secret& site,
                   const std::string& address) {
  const bool distrust =
      why.code == error_code::unauthorized && !site.identity();
  return {why.code, why.message, "",
          distrust ? site_token_hint(site.file(), address) : why.hint, ""};
}

/// On the io thread: the coordinator may have what makes this node's identity
/// count for longer.
void note_outcome(const connector_parts& parts, note_coordinator whom,
                  const session_result& result) {
  if (!parts.keeper)
    return;
  if (const auto* session = std::get_if<established_session>(&result)) {
    whom.uuid = session->peer.uuid;
    whom.present = true;
    whom.revocations = session->agreement.revocations;
  }
  caf::anon_send(parts.keeper, std::move(whom));
}

/// On the io thread: turns the outcome of an attempt into a message.
session_settled settle(caf::actor_system& system, const actor_context& context,
                       const connector_parts& parts, uint64_t attempt,
                       const socket_address& to, session_result result) {
  if (auto* why = std::get_if<edge_error>(&result))
    return {attempt, {}, refusal_of(*why, parts.site, to.address)};
  auto& session = std::get<established_session>(result);
  session_opened opened;
  opened.cell = session.peer.cell;
  opened.coordinator = session.peer.node;
  opened.incarnation = session.peer.number;
  opened.session = spawn_session(system, context, *parts.heartbeats,
                                 std::move(session), to.port);
  return {attempt, std::move(opened), {}};
}

/// Nobody would believe it: the site keeper asks there for another one, and
/// the next attempt has that.
caf::error wait_for_renewal(const connector_parts& parts,
                            const open_session& request) {
  if (parts.keeper)
    caf::anon_send(parts.keeper,
                   note_coordinator{request.address, request.uuid, false, 0});
  return fail(error_code::unreachable,
              "the certificate of this node has ended, and is being renewed at "
                  + request.address,
              "", "the events of this node say what comes of it");
}

caf::result<session_opened> open(session_connector_self self,
                                 const open_session& request) {
  auto& st = self->state;
  const auto place = parse_socket_address(request.address);
  if (!place)
    return fail(error_code::unreachable,
                "'" + request.address
                    + "' is not an address like 10.0.0.1:8420");
  if (const auto& own = st.parts.site.identity(); own && own->has_ended())
    return wait_for_renewal(st.parts, request);
  const auto attempt = ++st.attempts;
  auto promise = self->make_response_promise<session_opened>();
  st.pending.emplace(attempt, promise);
  const note_coordinator whom{request.address, request.uuid, false, 0};
  connect_session(*st.parts.io, {place->address, place->port, "", request.uuid},
                  {request.self.name, request.self.uuid, request.self.epoch,
                   request.role == node_role::coordinator
                       ? std::string{to_word(request.role)}
                       : std::string{}},
                  st.parts.site, {},
                  [&system = self->system(), context = st.context,
                   parts = st.parts, attempt, to = *place, whom,
                   me = session_connector_actor{self}](session_result result) {
                    note_outcome(parts, whom, result);
                    caf::anon_send(me, settle(system, context, parts, attempt,
                                              to, std::move(result)));
                  });
  return promise;
}

void on_settled(session_connector_self self, const session_settled& event) {
  auto i = self->state.pending.find(event.attempt);
  if (i == self->state.pending.end())
    return;
  auto promise = std::move(i->second);
  self->state.pending.erase(i);
  if (event.opened.session)
    promise.deliver(event.opened);
  else
    promise.deliver(to_error(event.problem));
}

} // namespace

session_connector_actor::behavior_type
session_connector(session_connector_self self, const actor_context& context,
                  const connector_parts& parts) {
  self->state.context = context;
  self->state.parts = parts;
  return {
      [self](const state_query&) {
        return state_of({{"attempts", self->state.attempts},
                         {"pending", self->state.pending.size()}});
      },
      [self](const open_session& request) { return open(self, request); },
      [self](const session_settled& event) { on_settled(self, event); },
  };
}

} // namespace roscell
