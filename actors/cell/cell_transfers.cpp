#include "actors/cell/cell_departures.hpp"

#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/failure.hpp"

namespace roscell {

namespace {

node_transferred reply_of(const node_transfer&, const cell_transfer& x) {
  return {x.row.node,     x.row.from,   x.row.to,
          x.row.transfer, x.terminated, x.rescheduled};
}

node_released reply_of(const node_release&, const cell_transfer& x) {
  return {x.row.node, x.row.from, x.row.transfer, x.terminated, x.rescheduled};
}

transfer_order transfer_order_of(const node_transfer& x) {
  return {x.node, x.target, x.instances};
}

transfer_order transfer_order_of(const node_release& x) {
  return {x.node, "", x.instances};
}

/// Has the node's own coordinator carry the request out.
template <class Reply, class Request>
caf::result<Reply> forward_to_holder(coordinator_pointer self,
                                     const peer_actor& holder,
                                     Request request) {
  auto promise = self->make_response_promise<Reply>();
  request.forwarded = true;
  self->request(holder, limits::transfer::forwarded, request)
      .then([promise](Reply& x) mutable { promise.deliver(std::move(x)); },
            [promise](caf::error& why) mutable {
              promise.deliver(std::move(why));
            });
  return promise;
}

template <class Reply, class Request>
caf::result<Reply> let_go(coordinator_pointer self, const Request& request) {
  if (!request.forwarded) {
    const auto found = find_named_node(self->state, request.node, request.cell);
    if (!found.why.message.empty())
      return to_error(found.why);
    if (found.holder)
      return forward_to_holder<Reply>(self, found.holder, request);
  }
  auto promise = self->make_response_promise<Reply>();
  start_transfer(self, transfer_order_of(request),
                 [promise, request](const cell_transfer& x,
                                    const completion& left) mutable {
                   if (!left)
                     promise.deliver(to_error(left.error()));
                   else
                     promise.deliver(reply_of(request, x));
                 });
  return promise;
}

/// A node that was told to go and is not in this cell's reach any more is lost,
/// so that its name is free after a lease and its row can be released.
void fail_departed_node(coordinator_pointer self, const transfer_row& row) {
  auto& registry = self->state.registry;
  auto* entry = registry.find_uuid(row.uuid);
  if (!entry || entry->member || entry->row.state != row_state::departing)
    return;
  registry.deactivate(
      *entry, row_state::lost,
      "it left for "
          + (row.to.empty() ? "independence" : "cell '" + row.to + "'")
          + " and has not been heard of since",
      now_of(self));
  publish(self, {row.uuid});
  publish_node_lost(self, *entry);
  arm_balance(self);
}

/// For what a transfer waits that has not begun to switch its node.
std::string wait_of(const cell_coordinator_state& st, const std::string& node) {
  for (const auto& x : st.pending.not_stop_safe)
    if (x.wait.node == node)
      return "'" + x.wait.task + "/" + x.wait.step + "' to be stop-safe";
  const auto waits = st.moves.waits_on(node);
  return waits.empty() ? "what runs there" : waits;
}

void settle_overdue(coordinator_pointer self, cell_transfer& x) {
  if (x.row.state == transfer_state::preparing)
    return call_off_transfer(
        self, x.row.transfer,
        {error_code::timeout,
         "node '" + x.row.node + "' stays: it has waited for too long for "
             + wait_of(self->state, x.row.node),
         "/instances",
         "`roscell tasks` shows what is waited for; send the request again"});
  const auto waiting = self->state.transfers.set_unresolved(
      x, "neither the node nor the other cell has said how it ended",
      now_of(self).unix_ms);
  const auto reported = x;
  persist_record(self, record_of(reported.row));
  fail_departed_node(self, reported.row);
  const failure why{error_code::unresolved,
                    "the transfer '" + reported.row.transfer + "' of node '"
                        + reported.row.node + "' is not settled yet",
                    "/node",
                    "`roscell transfers` shows how it stands; it resolves "
                    "itself when the parties meet again"};
  for (const auto& done : waiting)
    done(reported, why);
}

} // namespace

caf::result<node_transferred> transfer_node(coordinator_pointer self,
                                            const node_transfer& request) {
  return let_go<node_transferred>(self, request);
}

caf::result<node_released> release_node(coordinator_pointer self,
                                        const node_release& request) {
  return let_go<node_released>(self, request);
}

caf::result<transfer_description>
describe_transfers(coordinator_pointer self, const transfer_query& query) {
  transfer_description result{self->state.transfers.rows(query.transfer)};
  if (!query.transfer.empty() && result.transfers.empty())
    return fail(error_code::unknown_task,
                "no transfer '" + query.transfer + "' is remembered",
                "/transfer", "its own coordinator may remember it");
  return result;
}

void restore_transfers(coordinator_pointer self) {
  auto& st = self->state;
  st.transfers = transfer_table{st.setup.cell, st.setup.incarnation};
  for (const auto& row : st.setup.transfers) {
    st.transfers.restore(row);
    auto* x = st.transfers.find_open(row.transfer);
    if (!x)
      continue;
    // The row is dropped first, when it is known that the node has gone.
    if (!st.registry.find_uuid(row.uuid))
      end_transfer(self, row.transfer, transfer_state::done, "", {});
    else
      st.transfers.set_unresolved(*x, "the coordinator was started again",
                                  now_of(self).unix_ms);
  }
}

void settle_overdue_transfers(coordinator_pointer self) {
  auto& table = self->state.transfers;
  for (const auto& id : table.overdue(self->clock().now()))
    if (auto* x = table.find_open(id))
      settle_overdue(self, *x);
}

} // namespace roscell
