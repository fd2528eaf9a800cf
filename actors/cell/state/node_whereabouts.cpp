#include "actors/cell/state/node_whereabouts.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/transfer_end.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

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

} // namespace roscell
