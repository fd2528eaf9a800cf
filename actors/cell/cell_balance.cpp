#include "actors/cell/cell_slots.hpp"

#include "actors/cell/cell_departures.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/cell_instances.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/core/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace roscell {

namespace {

using time_point = std::chrono::steady_clock::time_point;

std::vector<cell_size> sizes_of(const cell_coordinator_state& st) {
  std::vector<cell_size> result;
  result.push_back({st.setup.self.uuid, st.setup.cell,
                    static_cast<int64_t>(st.registry.size())});
  st.peers.for_each_session([&](const std::string& uuid,
                                const peer_entry& peer) {
    if (peer.reported && peer.status.rebalance)
      result.push_back({uuid, peer.status.place.cell, size_of(st, uuid, peer)});
  });
  return result;
}

std::string cell_of(const std::vector<cell_size>& cells,
                    const std::string& uuid) {
  for (const auto& x : cells)
    if (x.uuid == uuid)
      return x.cell;
  return {};
}

/// One cell has done what it could. Once all have, it is looked at again as
/// long as something moves. What cannot be moved is not tried again soon, if
/// something else wants the sizes looked at: it costs the member its session.
void on_handed_over(coordinator_pointer self, bool moved) {
  auto& st = self->state;
  --st.balancing;
  if (moved)
    return arm_balance(self);
  if (st.balance_due != time_point::max())
    st.balance_due =
        std::max(st.balance_due, self->clock().now() + limits::retry::longest);
  set_timer(self);
}

void order_move(coordinator_pointer self, const cell_move& move,
                const std::string& target) {
  auto& st = self->state;
  ++st.balancing;
  st.context.publish_event(events::cells_rebalanced, target,
                           {{"members", move.count}});
  const member_surrender request{target, move.count};
  auto done = [self](const members_surrendered& x) {
    on_handed_over(self, !x.nodes.empty());
  };
  auto failed = [self](const caf::error&) { on_handed_over(self, false); };
  if (move.from == st.setup.self.uuid)
    self->request(cell_coordinator_actor{self}, limits::transfer::forwarded,
                  request)
        .then(done, failed);
  else
    self->request(st.peers.find(move.from)->actor, limits::transfer::forwarded,
                  request)
        .then(done, failed);
}

/// Whether a member may be moved without asking anybody.
bool is_movable(const cell_coordinator_state& st, const registry_entry& x) {
  return x.row.state == row_state::active && x.member
         && x.origin == join_origin::discovered
         && !has_instances(st, x.row.identity.name);
}

std::vector<std::string> movable(coordinator_pointer self, size_t count) {
  std::vector<std::string> result;
  self->state.registry.for_each_active([&](registry_entry& x) {
    if (result.size() < count && is_movable(self->state, x))
      result.push_back(x.row.identity.name);
  });
  return result;
}

} // namespace

std::vector<cell_move> plan_balancing(std::vector<cell_size> cells) {
  std::sort(cells.begin(), cells.end(), [](const auto& x, const auto& y) {
    return x.size != y.size ? x.size > y.size : x.uuid < y.uuid;
  });
  int64_t total = 0;
  for (const auto& x : cells)
    total += x.size;
  const auto count = static_cast<int64_t>(cells.size());
  std::vector<int64_t> surplus;
  for (int64_t i = 0; i < count; ++i) {
    const auto& x = cells[static_cast<size_t>(i)];
    surplus.push_back(x.size - total / count - (i < total % count ? 1 : 0));
  }
  std::vector<cell_move> result;
  size_t to = cells.size();
  for (size_t from = 0; from < cells.size(); ++from) {
    while (surplus[from] > 0) {
      while (surplus[to - 1] >= 0)
        --to;
      const auto n = std::min(surplus[from], -surplus[to - 1]);
      result.push_back({cells[from].uuid, cells[to - 1].uuid, n});
      surplus[from] -= n;
      surplus[to - 1] += n;
    }
  }
  return result;
}

void balance_if_due(coordinator_pointer self) {
  auto& st = self->state;
  if (self->clock().now() < st.balance_due || st.balancing > 0)
    return;
  st.balance_due = time_point::max();
  if (!is_slot_arbiter(st))
    return;
  const auto cells = sizes_of(st);
  for (const auto& move : plan_balancing(cells))
    order_move(self, move, cell_of(cells, move.to));
}

caf::result<members_surrendered>
hand_over_members(coordinator_pointer self, const member_surrender& request) {
  auto& st = self->state;
  if (!st.setup.rebalance)
    return fail(error_code::conflict,
                "cell '" + st.setup.cell + "' does not take part in balancing");
  struct tally {
    size_t open = 1;
    members_surrendered result;
  };
  auto promise = self->make_response_promise<members_surrendered>();
  auto state = std::make_shared<tally>();
  auto finish_one = [state, promise]() mutable {
    if (--state->open == 0)
      promise.deliver(std::move(state->result));
  };
  for (const auto& name : movable(self, static_cast<size_t>(request.count))) {
    ++state->open;
    transfer_order order;
    order.node = name;
    order.target = request.target;
    order.origin = join_origin::discovered;
    start_transfer(self, order,
                   [state, finish_one, name](const cell_transfer&,
                                             const completion& left) mutable {
                     if (left)
                       state->result.nodes.push_back(name);
                     finish_one();
                   });
  }
  finish_one();
  return promise;
}

} // namespace roscell
