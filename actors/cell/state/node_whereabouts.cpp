#include "actors/cell/state/node_whereabouts.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <map>
#include <utility>

namespace roscell {

void on_node_elsewhere(coordinator_pointer self, const std::string& uuid,
                       int64_t epoch, const std::string& cell) {
  auto& st = self->state;
  auto* entry = st.registry.find_uuid(uuid);
  if (!entry || entry->row.identity.epoch > epoch)
    return;
  const auto name = entry->row.identity.name;
  const auto member = entry->member;
  drop_row(self, uuid);
  if (member)
    self->send(member, close_session{"the node is elsewhere"});
  st.context.publish_event(
      events::node_left, name,
      {{"reason",
        cell.empty() ? "it is independent" : "it is in cell '" + cell + "'"},
       {"size", st.registry.active_count()}});
  const auto* x = st.transfers.find_open_of(uuid);
  if (!x)
    return;
  const auto id = x->row.transfer;
  if (x->row.to == cell)
    return end_transfer(self, id, transfer_state::done, "", {});
  const failure why{error_code::conflict,
                    "node '" + name + "' went elsewhere meanwhile", "/node"};
  end_transfer(self, id, transfer_state::returned, why.message, why);
}

void on_node_returned(coordinator_pointer self, const std::string& uuid) {
  const auto* x = self->state.transfers.find_open_of(uuid);
  if (!x)
    return;
  const auto id = x->row.transfer;
  const auto name = "node '" + x->row.node + "'";
  const failure why =
      x->row.state == transfer_state::preparing
          ? failure{error_code::unreachable,
                    name
                        + " lost its session before it was told to go, and "
                          "has come back",
                    "/node", "send the request again"}
          : failure{error_code::unreachable,
                    name + " could not register with cell '" + x->row.to
                        + "' and has come back",
                    "/target",
                    "`roscell events --since 0` on the node shows why"};
  end_transfer(self, id, transfer_state::returned, why.message, why);
}

bool fail_departing_node(coordinator_pointer self, registry_entry& entry,
                         const std::string& reason) {
  auto& st = self->state;
  const auto& who = entry.row.identity;
  entry.agent = nullptr;
  entry.member = nullptr;
  const auto* x = st.transfers.find_open_of(who.uuid);
  // Where it turns up tells the rest, if it has been told to go.
  if (x && x->row.state == transfer_state::switching)
    return false;
  if (x && x->row.state == transfer_state::preparing)
    call_off_transfer(self, x->row.transfer,
                      {error_code::unreachable,
                       "node '" + who.name + "' missed its heartbeats", "/node",
                       "it stays in the cell; send the request again when it "
                       "is back"});
  else
    st.registry.deactivate(entry, row_state::lost, reason, now_of(self));
  arm_balance(self);
  return true;
}

void publish_node_lost(coordinator_pointer self, const registry_entry& entry) {
  self->state.context.publish_event(
      events::node_lost, entry.row.identity.name,
      {{"reason", entry.row.reason},
       {"size", self->state.registry.active_count()}});
}

namespace {

/// The failure as whoever asked hears it.
failure with_losses(failure why, const cell_transfer& x) {
  if (x.terminated.empty())
    return why;
  why.message += "; terminated for it:";
  for (const auto& task : x.terminated)
    why.message += " '" + task + "'";
  return why;
}

void publish_transfer_end(coordinator_pointer self, const transfer_row& row) {
  json data{{"transfer", row.transfer},
            {"from", row.from},
            {"to", row.to},
            {"state", row.state}};
  if (!row.reason.empty())
    data["reason"] = row.reason;
  self->state.context.publish_event(events::transfer_ended, row.node, data);
}

} // namespace

void end_transfer(coordinator_pointer self, const std::string& id,
                  transfer_state state, const std::string& reason,
                  const completion& how) {
  auto& table = self->state.transfers;
  const auto ended = table.end(id, state, reason, now_of(self).unix_ms);
  if (!ended)
    return;
  persist_record(self, record_of(ended->row));
  for (const auto& old : table.forget_oldest())
    persist_record(self, {"transfers", old, ""});
  publish_transfer_end(self, ended->row);
  const auto reported =
      how ? completion{} : completion{with_losses(how.error(), *ended)};
  for (const auto& done : ended->waiting)
    done(*ended, reported);
}

void call_off_transfer(coordinator_pointer self, const std::string& id,
                       const failure& why) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  auto* entry = st.registry.find_uuid(x->row.uuid);
  if (entry && entry->row.state == row_state::departing) {
    if (entry->member)
      st.registry.stay(*entry, now_of(self));
    else
      st.registry.deactivate(*entry, row_state::lost,
                             "it missed its heartbeats while it was to leave",
                             now_of(self));
    publish(self, {entry->row.identity.uuid});
    arm_balance(self);
  }
  end_transfer(self, id, transfer_state::returned, why.message, why);
}

void await_arrival(coordinator_pointer self, const std::string& uuid,
                   completion_handler done) {
  if (self->state.slots.await_arrival(uuid, done, self->clock().now()))
    return set_timer(self);
  done(failure{error_code::conflict, "too many requests wait for nodes to join",
               "", "send the request again when some have joined"});
}

void settle_arrivals(coordinator_pointer self, const std::string& uuid,
                     const completion& how) {
  for (const auto& x : self->state.slots.take_arrivals(uuid))
    x.done(how);
}

void settle_overdue_arrivals(coordinator_pointer self) {
  const failure why{error_code::unresolved,
                    "the node was told to join and has not done so in time", "",
                    "send the request again; `roscell events --since 0` on the "
                    "node shows why"};
  auto& table = self->state.slots;
  for (const auto& x : table.take_overdue_arrivals(self->clock().now()))
    x.done(why);
}

namespace {

/// The nodes of that name in other cells, each once: of several claims of one
/// node the one with the highest epoch is right.
std::map<std::string, named_node>
nodes_elsewhere(const cell_coordinator_state& st, const std::string& node) {
  std::map<std::string, named_node> result;
  st.peers.for_each_session([&](const std::string&, const peer_entry& peer) {
    for (const auto& [uuid, claim] : peer.members) {
      if (!peer.reported || claim.name != node)
        continue;
      auto& known = result[uuid];
      if (!known.holder || known.claim.epoch < claim.epoch)
        known = {peer.actor, claim, peer.status.place.cell, {}};
    }
  });
  return result;
}

constexpr auto name_the_cell =
    "name its cell: \"cell\" in the request, `--cell` on the command line";

failure in_several(const std::string& node,
                   const std::map<std::string, named_node>& found) {
  std::string cells;
  for (const auto& [uuid, x] : found)
    cells += (cells.empty() ? "'" : ", '") + x.cell + "'";
  return {error_code::conflict,
          "several cells have a node '" + node + "': " + cells, "/node",
          name_the_cell};
}

/// A request that is sent twice must not take another node the second time.
failure gone_from_here(const transfer_row& gone, const std::string& cell) {
  return {error_code::unknown_node,
          "cell '" + gone.from + "' has no node '" + gone.node
              + "' any more: it went with transfer '" + gone.transfer
              + "'; the one in cell '" + cell + "' was not named",
          "/node", name_the_cell};
}

/// A transferred node is followed to where it went; a released one is not.
bool is_another(const transfer_row& gone, const named_node& found) {
  return gone.to.empty() || gone.uuid != found.claim.uuid;
}

named_node find_in_cell(const cell_coordinator_state& st,
                        const std::string& cell) {
  if (const auto* peer = st.peers.find_cell(cell))
    return {peer->actor, {}, cell, {}};
  return {{},
          {},
          {},
          {error_code::unknown_cell,
           "no coordinator of a cell '" + cell + "' is within reach", "/cell",
           "`roscell cells` lists them"}};
}

} // namespace

named_node find_elsewhere(const cell_coordinator_state& st,
                          const std::string& node) {
  const auto found = nodes_elsewhere(st, node);
  if (found.size() > 1)
    return {{}, {}, {}, in_several(node, found)};
  return found.empty() ? named_node{} : found.begin()->second;
}

named_node find_named_node(const cell_coordinator_state& st,
                           const std::string& node, const std::string& cell) {
  if (!cell.empty() && cell != st.setup.cell)
    return find_in_cell(st, cell);
  if (!cell.empty() || st.registry.find_name(node))
    return {};
  auto found = find_elsewhere(st, node);
  const auto* gone = st.transfers.find_gone(node);
  if (found.holder && gone && is_another(*gone, found))
    return {{}, {}, {}, gone_from_here(*gone, found.cell)};
  return found;
}

} // namespace roscell
