#include "actors/cell/transfers/transfer_start.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/transfer_end.hpp"
#include "actors/cell/transfers/transfer_instances.hpp"
#include "actors/cell/transfers/transfer_switch.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

void refuse_transfer(const transfer_done& done, const failure& why) {
  done(cell_transfer{}, why);
}

void withdraw_transfer(coordinator_pointer self, const std::string& id,
                       const failure& why) {
  for (const auto& done : self->state.transfers.withdraw(id))
    refuse_transfer(done, why);
  forget_refused(self, "transfers", id);
}

failure came_back(const std::string& node) {
  return {error_code::conflict,
          "node '" + node + "' came back, or went elsewhere, meanwhile",
          "/node", "send the request again"};
}

/// The node is away and its row is let go. It comes back if it ever wants to:
/// nobody can tell it.
void drop_absent(coordinator_pointer self, const std::string& id) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  const auto* entry = st.registry.find_uuid(x->row.uuid);
  if (!entry || entry->member)
    return call_off_transfer(self, id, came_back(x->row.node));
  const auto name = x->row.node;
  drop_row(self, x->row.uuid);
  st.context.publish_event(events::node_left, name,
                           {{"reason", "it was released while it was away"},
                            {"size", st.registry.active_count()}});
  end_transfer(self, id, transfer_state::done,
               "the node was away and could not be told", {});
}

/// Removes the record first: what cannot be written down is not done.
void release_absent(coordinator_pointer self, const std::string& id) {
  const auto* x = self->state.transfers.find_open(id);
  if (!x)
    return;
  keep_records(
      self, {{"members", x->row.uuid, ""}},
      [self, id] { drop_absent(self, id); },
      [self, id](const failure& why) { call_off_transfer(self, id, why); });
}

void begin_departure(coordinator_pointer self, const std::string& id,
                     const transfer_order& order, registry_entry& entry) {
  auto& st = self->state;
  st.registry.depart(entry, now_of(self));
  publish(self, {entry.row.identity.uuid});
  st.context.publish_event(events::node_departing, order.node,
                           {{"transfer", id}, {"to", order.target}});
  reserve_target(self, id, [self, id, order] {
    clear_instances(self, id, order.instances, [self, id, order] {
      order_switch(self, id, order.origin);
    });
  });
}

/// An earlier transfer of a node that is away is given up for a new one.
void end_unresolved(coordinator_pointer self, const std::string& uuid) {
  const auto* x = self->state.transfers.find_open_of(uuid);
  if (!x)
    return;
  const failure why{error_code::conflict,
                    "node '" + x->row.node + "' was released while it was away",
                    "/node"};
  end_transfer(self, x->row.transfer, transfer_state::returned, why.message,
               why);
}

/// The proposed transfer is kept. What spoke against it is asked once more: the
/// store took its time.
void on_transfer_persisted(coordinator_pointer self, const std::string& id,
                           const transfer_order& order) {
  auto& st = self->state;
  if (const auto* proposed = st.transfers.find_proposed(id))
    end_unresolved(self, proposed->row.uuid);
  st.transfers.open(id);
  auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  x->deadline = self->clock().now() + limits::transfer::preparing;
  set_timer(self);
  auto* entry = st.registry.find_uuid(x->row.uuid);
  if (!entry)
    return call_off_transfer(self, id, came_back(order.node));
  if (auto why = objection_to_instances(st, order))
    return call_off_transfer(self, id, *why);
  if (entry->member && entry->row.state == row_state::active)
    return begin_departure(self, id, order, *entry);
  if (entry->member || !order.target.empty())
    return call_off_transfer(self, id, came_back(order.node));
  clear_instances(self, id, order.instances,
                  [self, id] { release_absent(self, id); });
}

} // namespace

void start_transfer(coordinator_pointer self, const transfer_order& order,
                    transfer_done done) {
  auto& st = self->state;
  if (auto why = objection_to(self, order))
    return refuse_transfer(done, *why);
  const auto uuid = st.registry.find_name(order.node)->row.identity.uuid;
  const auto row = st.transfers.propose(order.node, uuid, order.target,
                                        now_of(self).unix_ms);
  const auto id = row.transfer;
  st.transfers.find_proposed(id)->waiting.push_back(std::move(done));
  keep_records(
      self, {record_of(row)},
      [self, id, order] { on_transfer_persisted(self, id, order); },
      [self, id](const failure& why) { withdraw_transfer(self, id, why); });
}

} // namespace roscell
