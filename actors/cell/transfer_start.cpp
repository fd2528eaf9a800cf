#include "actors/cell/cell_departures.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
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

namespace {

std::string list_instances(const std::vector<instance_spec>& specs) {
  std::string result;
  for (const auto& x : specs)
    result += (result.empty() ? "'" : ", '") + x.instance + "'";
  return result;
}

/// A row that is on its way in or out. One whose transfer is unresolved may be
/// let go while the node is away: nobody else can settle that.
std::optional<failure> objection_of_row(const cell_coordinator_state& st,
                                        const registry_entry& entry) {
  const auto& row = entry.row;
  const auto name = "node '" + row.identity.name + "'";
  if (row.state == row_state::reserved)
    return failure{error_code::conflict, name + " is reserved", "/node",
                   "wait until it has joined"};
  const auto id = st.transfers.holder_of(row.identity.uuid);
  const bool settles_by_itself =
      st.transfers.is_busy(row.identity.uuid) || entry.member;
  if (id.empty() || !settles_by_itself)
    return std::nullopt;
  return failure{error_code::conflict, name + " is departing", "/node",
                 "its transfer is '" + id + "'"};
}

} // namespace

std::optional<failure> objection_to(coordinator_pointer self,
                                    const transfer_order& order) {
  auto& st = self->state;
  const auto name = "node '" + order.node + "'";
  const auto* entry = st.registry.find_name(order.node);
  if (!entry)
    return failure{error_code::unknown_node, "no " + name + " is in any cell",
                   "/node", "`roscell nodes` lists those of a cell"};
  if (entry->row.identity.uuid == st.setup.self.uuid)
    return failure{error_code::conflict,
                   name + " coordinates cell '" + st.setup.cell
                       + "': a coordination node cannot leave its cell",
                   "/node"};
  if (order.target == st.setup.cell)
    return failure{error_code::conflict,
                   name + " is in cell '" + st.setup.cell + "' already",
                   "/target"};
  if (auto why = objection_of_row(st, *entry))
    return why;
  if (!order.target.empty() && !entry->member)
    return failure{error_code::unreachable,
                   name + " is " + std::string{to_word(entry->row.state)},
                   "/node", "try again when it is back"};
  if (!order.target.empty() && !st.peers.find_cell(order.target))
    return failure{error_code::unknown_cell,
                   "no coordinator of a cell '" + order.target
                       + "' is within reach",
                   "/target", "`roscell cells` lists them"};
  return objection_to_instances(st, order);
}

std::optional<failure> objection_to_instances(const cell_coordinator_state& st,
                                              const transfer_order& order) {
  const auto specs = st.deployments.bound_to(order.node);
  if (order.instances != instance_policy::refuse || specs.empty())
    return std::nullopt;
  return failure{error_code::conflict,
                 "node '" + order.node + "' runs, or is being sent, "
                     + list_instances(specs),
                 "/instances",
                 "say \"terminate\" or \"reschedule\" to let it go"};
}

} // namespace roscell
