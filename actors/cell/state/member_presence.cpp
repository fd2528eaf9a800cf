#include "actors/cell/state/member_presence.hpp"

#include "actors/core/alarm.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/session/limits.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <utility>

namespace roscell {

namespace {

constexpr std::chrono::seconds silent_host{60};

} // namespace

void meet_member_server(coordinator_pointer self, int64_t server_id,
                        bool tells_anew, std::function<void()> then) {
  const auto& discovery = self->state.setup.discovery;
  if (!discovery || server_id < 0)
    return then();
  follow_server request;
  request.server_id = server_id;
  request.tells_anew = tells_anew;
  self->request(discovery, limits::local::part, request)
      .then([then](caf::ok_atom) { then(); },
            [then](const caf::error&) { then(); });
}

void follow_member_server(coordinator_pointer self, const registry_entry& entry,
                          server_contact contact) {
  const auto& discovery = self->state.setup.discovery;
  if (!discovery || entry.server_id < 0)
    return;
  follow_server request;
  request.server_id = entry.server_id;
  request.contact = contact;
  caf::anon_send(discovery, request);
}

void doubt_silent_host(coordinator_pointer self, const registry_entry& entry) {
  const auto& discovery = self->state.setup.discovery;
  if (!discovery || entry.server_id < 0)
    return;
  follow_server request;
  request.server_id = entry.server_id;
  request.contact = server_contact::settled;
  send_lasting_actor_later(discovery, silent_host, request);
}

bool is_in_doubt(const cell_coordinator_state& st, const node_presence& who) {
  const auto* entry = st.registry.find_uuid(who.uuid);
  if (!entry || who.role != "independent")
    return false;
  const auto& row = entry->row;
  // Every registration has an epoch of its own, so one of the row's epoch has
  // come to nothing.
  return row.state != row_state::active && row.state != row_state::reserved
         && who.epoch >= row.identity.epoch;
}

std::chrono::steady_clock::time_point
next_proof(const cell_coordinator_state& st) {
  if (!st.setup.registration)
    return std::chrono::steady_clock::time_point::max();
  return st.unassigned_nodes.next_question(
      [&](const node_presence& who) { return is_in_doubt(st, who); });
}

namespace {

/// A node on the same site answers within milliseconds, and the one that wants
/// its row waits meanwhile.
constexpr std::chrono::seconds member_proof{1};

static_assert(member_proof < limits::membership::registration);

/// Whoever refuses to answer is there.
bool shows_absence(const caf::error& why) {
  const auto code = to_failure(why).code;
  return code == error_code::timeout || code == error_code::unreachable;
}

} // namespace

void prove_member(coordinator_pointer self, const member_actor& member,
                  const std::function<void(bool is_there)>& then) {
  self->request(member, member_proof, resource_query{})
      .then([then](const resource_report&) { then(true); },
            [then](const caf::error& why) { then(!shows_absence(why)); });
}

} // namespace roscell
