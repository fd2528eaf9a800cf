#include "actors/cell/cell_presences.hpp"

#include "actors/cell/cell_peers.hpp"
#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/doubts.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/core/wall_clock.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

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
