#include "actors/cell/cell_peers.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/member_presence.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/watching.hpp"
#include "actors/session/limits.hpp"
#include "actors/session/peer.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

cell_standing own_cell_status(const cell_coordinator_state& st) {
  cell_standing result;
  result.place = own_address(st.setup);
  result.uuid = st.setup.self.uuid;
  result.cell_uuid = st.setup.cell_uuid;
  result.incarnation = st.setup.incarnation;
  result.size = static_cast<int64_t>(st.registry.size());
  result.rebalance = st.setup.rebalance;
  result.members = st.registry.claims();
  result.server_id = st.setup.server_id;
  result.domain_id = st.setup.ros_domain_id;
  return result;
}

void spawn_peer(coordinator_pointer self, const session_actor& session,
                const std::string& uuid, bool opened_here) {
  spawn(self->system(), self->state.context, peer,
        peer_setup{session, uuid, opened_here, cell_coordinator_actor{self}});
}

void on_attempt_failed(coordinator_pointer self, const std::string& uuid,
                       const std::string& reason) {
  auto& st = self->state;
  const auto cell = st.peers.attempt_failed(uuid, reason, self->clock().now());
  if (cell)
    st.context.publish_event(events::peer_unreachable, *cell,
                             {{"reason", reason}});
  set_timer(self);
}

void on_attempt_succeeded(coordinator_pointer self, const std::string& uuid,
                          const session_opened& opened) {
  if (self->state.peers.attempt_succeeded(uuid))
    spawn_peer(self, opened.session, uuid, true);
  else
    self->send(opened.session, close_session{"not wanted any more"});
  set_timer(self);
}

void open_peer(coordinator_pointer self, const node_presence& who) {
  auto& st = self->state;
  auto me = st.setup.self;
  me.epoch = st.setup.incarnation;
  self->request(st.setup.connector, limits::session::open,
                open_session{who.address, me, node_role::coordinator, who.uuid})
      .then(
          [self, uuid = who.uuid](const session_opened& opened) {
            on_attempt_succeeded(self, uuid, opened);
          },
          [self, uuid = who.uuid](const caf::error& why) {
            on_attempt_failed(self, uuid, to_failure(why).message);
          });
}

/// The node stays, or has gone, elsewhere.
void release_slot(coordinator_pointer self, const std::string& uuid) {
  drop_row(self, uuid);
  arm_balance(self);
}

/// What another coordinator says of a node. The higher epoch is right.
void weigh(coordinator_pointer self, const peer_entry& from,
           const member_claim& claim) {
  auto& st = self->state;
  // Its place has been taken, there or elsewhere.
  if (claim.active)
    st.slots.forget(claim.uuid);
  auto* entry = st.registry.find_uuid(claim.uuid);
  if (!entry || !claim.active || claim.uuid == st.setup.self.uuid)
    return;
  const auto& row = entry->row;
  if (row.state == row_state::reserved && row.identity.epoch <= claim.epoch)
    return release_slot(self, claim.uuid);
  if (row.identity.epoch < claim.epoch)
    on_node_elsewhere(self, claim.uuid, claim.epoch, from.status.place.cell);
  else if (row.state == row_state::active && from.actor)
    self->send(from.actor,
               cell_changed{static_cast<int64_t>(st.registry.size()),
                            {claim_of(row)},
                            {}});
}

} // namespace

void open_due_peers(coordinator_pointer self) {
  auto& st = self->state;
  if (!st.setup.connector)
    return;
  for (const auto& who : st.peers.begin_due(self->clock().now()))
    open_peer(self, who);
}

void on_peer_admitted(coordinator_pointer self, const session_admitted& event) {
  spawn_peer(self, event.session, event.peer.uuid, false);
}

void on_peer_opened(coordinator_pointer self, const peer_opened& event) {
  if (const auto former = self->state.peers.open(event.uuid, event.peer))
    self->send(former, close_session{"a newer session has been opened"});
  watch_until_its_end(self, event.peer);
  self->send(event.peer, own_cell_status(self->state));
}

void on_peer_lost(coordinator_pointer self, const peer_lost& event) {
  auto& st = self->state;
  const auto lost =
      st.peers.close(event.uuid, event.peer, event.reason, self->clock().now());
  if (!lost)
    return;
  if (lost->reported)
    st.context.publish_event(events::peer_lost, lost->status.place.cell,
                             {{"reason", event.reason}});
  arm_balance(self);
  set_timer(self);
}

void on_peer_down(coordinator_pointer self, const caf::actor_addr& gone) {
  const auto uuid = self->state.peers.find_uuid(gone);
  if (const auto* entry = self->state.peers.find(uuid))
    on_peer_lost(
        self, {entry->actor, uuid, "the part that spoke with it has failed"});
}

void on_peer_status_reported(coordinator_pointer self,
                             const peer_status_reported& event) {
  auto& st = self->state;
  const auto* entry = st.peers.note_status(event.peer, event.status);
  if (!entry)
    return;
  st.context.publish_event(events::peer_joined, event.status.place.cell,
                           {{"coordinator", event.status.place.coordinator},
                            {"address", event.status.place.address},
                            {"size", event.status.size}});
  for (const auto& claim : event.status.members)
    weigh(self, *entry, claim);
  arm_balance(self);
}

void on_peer_changed(coordinator_pointer self, const peer_changed& event) {
  auto& st = self->state;
  const auto* known = std::as_const(st.peers).find_session(event.peer);
  const auto before = known ? known->status.size : 0;
  const auto* entry = st.peers.note_status(event.peer, event.change);
  if (!entry)
    return;
  if (before != event.change.size)
    st.context.publish_event(events::peer_changed, entry->status.place.cell,
                             {{"size", event.change.size}});
  for (const auto& uuid : event.change.gone)
    st.slots.forget(uuid, entry->status.uuid);
  for (const auto& claim : event.change.changed)
    weigh(self, *entry, claim);
}

namespace {

bool is_coordinator(const node_presence& who) {
  return who.role == "coordinator";
}

void publish_name_conflict(coordinator_pointer self, const node_presence& who) {
  const auto& setup = self->state.setup;
  if (who.cell == setup.cell)
    self->state.context.publish_event(
        events::cell_name_conflict, who.cell,
        {{"coordinator", who.name},
         {"address", who.address},
         {"discovery_server", who.discovery_server}});
}

void on_coordinator_seen(coordinator_pointer self, const node_presence& who) {
  const auto what = self->state.peers.see(who, self->clock().now());
  if (what == peer_table::sighting::appeared)
    publish_name_conflict(self, who);
  open_due_peers(self);
  set_timer(self);
}

void on_unassigned_node_seen(coordinator_pointer self,
                             const node_presence& who) {
  auto& st = self->state;
  const auto what = st.unassigned_nodes.see(who, self->clock().now());
  if (what == unassigned_node_table::sighting::appeared)
    st.context.publish_event(events::node_appeared, who.name,
                             {{"role", who.role}, {"address", who.address}});
  ask_due_proofs(self);
  set_timer(self);
}

/// The node is in no cell, and has proved it.
void on_proof(coordinator_pointer self, const std::string& uuid,
              const status_proved& proof) {
  auto& st = self->state;
  const auto* who = st.unassigned_nodes.find(uuid);
  if (!st.unassigned_nodes.question_answered(uuid) || !who
      || !is_in_doubt(st, *who))
    return;
  if (proof.state == node_state::independent)
    return on_node_elsewhere(self, uuid, proof.identity.epoch, "");
  st.unassigned_nodes.question_failed(uuid, "it is in a cell, or on its way",
                                      self->clock().now());
  set_timer(self);
}

void ask_for_proof(coordinator_pointer self, const node_presence& who) {
  self->request(self->state.setup.registration,
                limits::unauthenticated_peers::proof,
                prove_status{who.address, who.name, who.uuid})
      .then([self, uuid = who.uuid](
                const status_proved& proof) { on_proof(self, uuid, proof); },
            [self, uuid = who.uuid](const caf::error& why) {
              self->state.unassigned_nodes.question_failed(
                  uuid, to_failure(why).message, self->clock().now());
              set_timer(self);
            });
}

} // namespace

void appear(coordinator_pointer self) {
  const auto& setup = self->state.setup;
  if (!setup.discovery)
    return;
  node_presence me;
  me.role = "coordinator";
  me.name = setup.self.name;
  me.uuid = setup.self.uuid;
  me.incarnation = setup.incarnation;
  me.cell = setup.cell;
  me.address = setup.self.address;
  me.discovery_server = setup.discovery_server;
  me.server_id = setup.server_id;
  me.cell_uuid = setup.cell_uuid;
  self->send(setup.discovery, announce_presence{std::move(me)});
}

void on_presence_seen(coordinator_pointer self, const node_presence& who) {
  if (who.uuid == self->state.setup.self.uuid)
    return;
  if (is_coordinator(who))
    on_coordinator_seen(self, who);
  else
    on_unassigned_node_seen(self, who);
}

void on_presence_gone(coordinator_pointer self, const node_presence& who) {
  auto& st = self->state;
  if (is_coordinator(who)) {
    if (st.peers.vanish(who))
      st.context.publish_event(events::peer_vanished, who.cell);
  } else if (st.unassigned_nodes.vanish(who, unix_now_ms())) {
    st.context.publish_event(events::node_vanished, who.name);
  }
}

void ask_due_proofs(coordinator_pointer self) {
  auto& st = self->state;
  if (!st.setup.registration)
    return;
  const auto due = st.unassigned_nodes.begin_questions(
      [&](const node_presence& who) { return is_in_doubt(st, who); },
      self->clock().now());
  for (const auto& who : due)
    ask_for_proof(self, who);
}

std::vector<unassigned_node>
list_unassigned_nodes(const cell_coordinator_state& st) {
  const auto is_in_a_cell = [&](const std::string& uuid) {
    bool found = st.registry.find_uuid(uuid) != nullptr;
    st.peers.for_each_session([&](const auto&, const peer_entry& peer) {
      found = found || peer.members.count(uuid) > 0;
    });
    return found;
  };
  auto result = st.unassigned_nodes.rows();
  const auto end = std::remove_if(
      result.begin(), result.end(), [&](const unassigned_node& x) {
        return x.silent_since_unix_ms != 0 && is_in_a_cell(x.uuid);
      });
  result.erase(end, result.end());
  return result;
}

std::vector<cell_row> list_cells(const cell_coordinator_state& st) {
  const cell_row own{st.setup.cell,
                     st.setup.self.name,
                     st.setup.self.address,
                     st.setup.discovery_server,
                     static_cast<int64_t>(st.registry.active_count()),
                     "",
                     st.setup.environment};
  auto result = st.peers.rows(own);
  result.insert(result.begin(), own);
  return result;
}

} // namespace roscell
