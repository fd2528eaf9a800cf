#include "actors/cell/cell_peers.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/cell/state/peer_attempts.hpp"
#include "actors/house/limits.hpp"
#include "actors/session/peer.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <functional>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;
using time_point = std::chrono::steady_clock::time_point;

cell_standing standing_of(const cell_coordinator_state& st) {
  cell_standing result;
  result.place = own_address(st.setup);
  result.uuid = st.setup.self.uuid;
  result.incarnation = st.setup.incarnation;
  result.size = static_cast<int64_t>(st.registry.size());
  result.rebalance = st.setup.rebalance;
  result.members = st.registry.claims();
  return result;
}

void try_later(self_pointer self, const std::string& uuid,
               const std::string& reason) {
  auto& st = self->state;
  auto& attempt = st.attempts[uuid];
  attempt.running = false;
  attempt.next = self->clock().now() + attempt.pause.next();
  if (attempt.trouble != reason)
    st.context.tell("peer_unreachable", st.presences[uuid].cell,
                    {{"reason", reason}});
  attempt.trouble = reason;
  set_timer(self);
}

void spawn_peer(self_pointer self, const session_actor& session,
                const std::string& uuid, bool opened_here) {
  spawn(self->system(), self->state.context, peer,
        peer_setup{session, uuid, opened_here, cell_coordinator_actor{self}});
}

void open_peer(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  st.attempts[who.uuid].running = true;
  auto me = st.setup.self;
  me.epoch = st.setup.incarnation;
  self->request(st.setup.connector, limits::session::open,
                open_session{who.address, me, node_role::coordinator})
      .then(
          [self, uuid = who.uuid](const session_opened& opened) {
            self->state.attempts[uuid].running = false;
            spawn_peer(self, opened.session, uuid, true);
          },
          [self, uuid = who.uuid](const caf::error& why) {
            try_later(self, uuid, to_failure(why).message);
          });
}

void tell_name_conflict(self_pointer self, const node_presence& who) {
  const auto& setup = self->state.setup;
  if (who.cell == setup.cell)
    self->state.context.tell("cell_name_conflict", who.cell,
                             {{"coordinator", who.name},
                              {"address", who.address},
                              {"discovery_server", who.discovery_server}});
}

/// A node with a row says publicly that it is in no cell: it has been released
/// and nobody could tell. Every registration has an epoch of its own, so one of
/// the row's epoch has come to nothing.
void on_free_node(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  auto* entry = st.registry.find_uuid(who.uuid);
  const bool away = entry && entry->row.state != row_state::active
                    && entry->row.state != row_state::reserved;
  if (away && who.role == "independent"
      && who.epoch >= entry->row.identity.epoch)
    on_node_elsewhere(self, who.uuid, who.epoch, "");
}

/// The node stays, or has gone, elsewhere.
void give_up_place(self_pointer self, const std::string& uuid) {
  drop_row(self, uuid);
  arm_balance(self);
}

/// What another coordinator says of a node. The higher epoch is right.
void weigh(self_pointer self, const peer_entry& from,
           const member_claim& claim) {
  auto& st = self->state;
  auto* entry = st.registry.find_uuid(claim.uuid);
  if (!entry || !claim.active || claim.uuid == st.setup.self.uuid)
    return;
  const auto& row = entry->row;
  if (row.state == row_state::reserved && row.identity.epoch <= claim.epoch)
    return give_up_place(self, claim.uuid);
  if (row.identity.epoch < claim.epoch)
    on_node_elsewhere(self, claim.uuid, claim.epoch, from.standing.place.cell);
  else if (row.state == row_state::active && from.actor)
    self->send(from.actor,
               cell_changed{static_cast<int64_t>(st.registry.size()),
                            {claim_of(row)},
                            {}});
}

peer_entry* find_actor(self_pointer self, const peer_actor& actor) {
  for (auto& [uuid, x] : self->state.peers)
    if (x.actor == actor)
      return &x;
  return nullptr;
}

} // namespace

void appear(self_pointer self) {
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
  self->send(setup.discovery, announce_presence{std::move(me)});
}

void on_presence_seen(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  if (who.uuid == st.setup.self.uuid)
    return;
  const bool known = st.presences.count(who.uuid) > 0;
  st.presences[who.uuid] = who;
  if (!is_coordinator(who)) {
    if (!known)
      st.context.tell("node_appeared", who.name,
                      {{"role", who.role}, {"address", who.address}});
    return on_free_node(self, who);
  }
  if (!known)
    tell_name_conflict(self, who);
  // It has just shown that it lives.
  st.attempts[who.uuid].next = self->clock().now();
  open_due_peers(self);
}

void on_row_vacated(self_pointer self, const std::string& uuid) {
  const auto& presences = self->state.presences;
  if (const auto i = presences.find(uuid); i != presences.end())
    on_free_node(self, i->second);
}

void on_presence_gone(self_pointer self, const node_presence& who) {
  auto& st = self->state;
  const auto i = st.presences.find(who.uuid);
  // A later life of the node may be known already.
  if (i == st.presences.end() || i->second.epoch != who.epoch
      || i->second.incarnation != who.incarnation || i->second.role != who.role)
    return;
  st.presences.erase(i);
  st.attempts.erase(who.uuid);
  st.context.tell(is_coordinator(who) ? "peer_vanished" : "node_vanished",
                  is_coordinator(who) ? who.cell : who.name);
}

void open_due_peers(self_pointer self) {
  auto& st = self->state;
  if (!st.setup.connector)
    return;
  std::vector<node_presence> due;
  for (const auto& [uuid, who] : st.presences)
    if (is_due(st, who, self->clock().now()))
      due.push_back(who);
  for (const auto& who : due)
    open_peer(self, who);
}

void on_peer_admitted(self_pointer self, const session_admitted& fact) {
  spawn_peer(self, fact.session, fact.peer.uuid, false);
}

void on_peer_opened(self_pointer self, const peer_opened& fact) {
  auto& entry = self->state.peers[fact.uuid];
  if (entry.actor && entry.actor != fact.peer)
    self->send(entry.actor, close_session{"a newer session has been opened"});
  entry = {};
  entry.actor = fact.peer;
  self->monitor(fact.peer);
  self->send(fact.peer, standing_of(self->state));
}

void on_peer_lost(self_pointer self, const peer_lost& fact) {
  auto& st = self->state;
  const auto i = st.peers.find(fact.uuid);
  if (i == st.peers.end() || i->second.actor != fact.peer)
    return;
  const auto cell = i->second.standing.place.cell;
  const bool told = i->second.told;
  st.peers.erase(i);
  if (told)
    st.context.tell("peer_lost", cell, {{"reason", fact.reason}});
  auto& attempt = st.attempts[fact.uuid];
  attempt.trouble = fact.reason;
  attempt.next = self->clock().now() + attempt.pause.next();
  arm_balance(self);
  set_timer(self);
}

void on_peer_told(self_pointer self, const peer_told& fact) {
  auto* entry = find_actor(self, fact.peer);
  if (!entry)
    return;
  auto& st = self->state;
  entry->told = true;
  entry->standing = fact.standing;
  entry->members.clear();
  for (const auto& claim : fact.standing.members)
    entry->members[claim.uuid] = claim;
  auto& attempt = st.attempts[fact.standing.uuid];
  attempt.pause.reset();
  attempt.trouble.clear();
  st.context.tell("peer_joined", fact.standing.place.cell,
                  {{"coordinator", fact.standing.place.coordinator},
                   {"address", fact.standing.place.address},
                   {"size", fact.standing.size}});
  for (const auto& claim : fact.standing.members)
    weigh(self, *entry, claim);
  arm_balance(self);
}

void on_peer_changed(self_pointer self, const peer_changed& fact) {
  auto* entry = find_actor(self, fact.peer);
  if (!entry || !entry->told)
    return;
  if (entry->standing.size != fact.change.size)
    self->state.context.tell("peer_changed", entry->standing.place.cell,
                             {{"size", fact.change.size}});
  entry->standing.size = fact.change.size;
  for (const auto& uuid : fact.change.gone)
    entry->members.erase(uuid);
  for (const auto& claim : fact.change.changed) {
    entry->members[claim.uuid] = claim;
    weigh(self, *entry, claim);
  }
}

peer_entry* find_peer(self_pointer self, const std::string& cell) {
  for (auto& [uuid, x] : self->state.peers)
    if (x.actor && x.told && x.standing.place.cell == cell)
      return &x;
  return nullptr;
}

peer_entry* find_peer_with(self_pointer self, const std::string& node) {
  peer_entry* result = nullptr;
  int64_t epoch = -1;
  for (auto& [uuid, x] : self->state.peers) {
    if (!x.actor || !x.told)
      continue;
    for (const auto& [member, claim] : x.members) {
      if (claim.name != node || claim.epoch <= epoch)
        continue;
      result = &x;
      epoch = claim.epoch;
    }
  }
  return result;
}

std::vector<cell_row> list_cells(self_pointer self) {
  const auto& st = self->state;
  std::vector<cell_row> result{
      {st.setup.cell, st.setup.self.name, st.setup.self.address,
       st.setup.discovery_server,
       static_cast<int64_t>(st.registry.active_count()), ""}};
  for (const auto& [uuid, who] : st.presences) {
    if (!is_coordinator(who))
      continue;
    cell_row row{who.cell, who.name, who.address, who.discovery_server, 0, ""};
    const auto peer = st.peers.find(uuid);
    const auto attempt = st.attempts.find(uuid);
    if (peer != st.peers.end() && peer->second.told)
      row.size = peer->second.standing.size;
    else if (attempt != st.attempts.end())
      row.trouble = attempt->second.trouble;
    if (who.cell == st.setup.cell)
      row.trouble =
          "it claims the same name as the cell of '" + st.setup.self.name + "'";
    result.push_back(std::move(row));
  }
  return result;
}

std::vector<free_node> list_free_nodes(self_pointer self) {
  std::vector<free_node> result;
  for (const auto& [uuid, who] : self->state.presences)
    if (!is_coordinator(who))
      result.push_back({who.name, who.uuid, who.address,
                        who.role == "orphaned" ? node_state::orphaned
                                               : node_state::independent,
                        who.cell});
  return result;
}

} // namespace roscell
