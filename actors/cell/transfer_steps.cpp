#include "actors/cell/cell_departures.hpp"
#include "actors/cell/limits.hpp"
#include "actors/cell/moves/task_move.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/session/limits.hpp"
#include "messages/failure.hpp"

#include <utility>
#include <vector>

namespace roscell {

namespace {

/// The departing row of an open transfer whose node has a session; null if that
/// is not so any more.
registry_entry* find_departing(coordinator_pointer self,
                               const cell_transfer& x) {
  auto* entry = self->state.registry.find_uuid(x.row.uuid);
  return entry && entry->row.state == row_state::departing && entry->member
             ? entry
             : nullptr;
}

failure missed_heartbeats(const cell_transfer& x) {
  return {error_code::unreachable,
          "node '" + x.row.node + "' missed its heartbeats", "/node"};
}

/// What is asked of the node.
registration_switch order_for(const cell_coordinator_state& st,
                              const cell_transfer& x,
                              const registry_entry& entry, join_origin origin) {
  registration_switch result;
  result.transfer = x.row.transfer;
  result.node = x.row.node;
  result.uuid = x.row.uuid;
  result.epoch = entry.row.identity.epoch;
  result.origin = origin;
  if (const auto* peer = st.peers.find_cell(x.row.to))
    result.target = {peer->status.place};
  return result;
}

void on_switch_accepted(coordinator_pointer self, const std::string& id) {
  const auto* x = self->state.transfers.find_open(id);
  // A released node has written down that it is, so it will not come back.
  if (x && x->row.to.empty())
    on_node_elsewhere(self, x->row.uuid, INT64_MAX, "");
}

/// Nobody knows whether the node has heard that it shall go. Where it registers
/// next tells, so it must not stay in a session that it may believe in.
void ask_where_it_goes(coordinator_pointer self, const cell_transfer& x) {
  if (const auto* entry = find_departing(self, x))
    self->send(entry->member,
               close_session{"it is not known whether the node goes"});
}

void on_switch_failed(coordinator_pointer self, const std::string& id,
                      const failure& why) {
  const auto* x = self->state.transfers.find_open(id);
  if (!x)
    return;
  if (why.code == error_code::unreachable || why.code == error_code::timeout)
    ask_where_it_goes(self, *x);
  else
    call_off_transfer(self, id, why);
}

/// The order may go out: it is on disk that the node may be anywhere.
void send_order(coordinator_pointer self, const std::string& id,
                const transfer_row& row, join_origin origin) {
  auto& st = self->state;
  auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  const auto* entry = find_departing(self, *x);
  if (!entry)
    return call_off_transfer(self, id, missed_heartbeats(*x));
  const auto order = order_for(st, *x, *entry, origin);
  if (!x->row.to.empty() && order.target.empty())
    return call_off_transfer(
        self, id,
        {error_code::unreachable,
         "the coordinator of cell '" + x->row.to + "' missed its heartbeats",
         "/target"});
  st.transfers.begin_switch(*x, row, self->clock().now());
  set_timer(self);
  self->request(entry->member, limits::membership::switching, order)
      .then([=](const switch_accepted&) { on_switch_accepted(self, id); },
            [=](const caf::error& why) {
              on_switch_failed(self, id, to_failure(why));
            });
}

} // namespace

void reserve_target(coordinator_pointer self, const std::string& id,
                    const std::function<void()>& next) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  if (x->row.to.empty())
    return next();
  const auto* entry = find_departing(self, *x);
  const auto* peer = st.peers.find_cell(x->row.to);
  if (!entry || !peer)
    return call_off_transfer(self, id,
                             {error_code::unreachable,
                              "node or target cell have just gone", "/target"});
  const auto& who = entry->row.identity;
  const std::chrono::milliseconds span{limits::transfer::place};
  self->request(peer->actor, limits::session::peer_answer,
                place_reservation{who.name, who.uuid, who.epoch, span.count()})
      .then([=](const place_reserved&) { next(); },
            [=](const caf::error& why) {
              call_off_transfer(self, id, to_failure(why));
            });
}

void order_switch(coordinator_pointer self, const std::string& id,
                  join_origin origin) {
  auto& table = self->state.transfers;
  const auto* x = table.find_open(id);
  if (!x)
    return;
  const auto row = table.switching_row(*x, now_of(self).unix_ms);
  keep_records(
      self, {record_of(row)}, [=] { send_order(self, id, row, origin); },
      [=](const failure& why) { call_off_transfer(self, id, why); });
}

namespace {

/// Ends the tasks one after the other, then goes on.
void terminate_tasks(coordinator_pointer self, const std::string& id,
                     std::vector<std::string> tasks,
                     const std::function<void()>& next) {
  auto* x = self->state.transfers.find_open(id);
  if (!x)
    return;
  if (tasks.empty())
    return next();
  const auto task = tasks.back();
  tasks.pop_back();
  // From here on nothing brings it back.
  x->terminated.push_back(task);
  self->request(cell_coordinator_actor{self}, limits::task::termination,
                task_termination{task})
      .then(
          [=](const task_terminated& reply) {
            const auto go_on = [=] { terminate_tasks(self, id, tasks, next); };
            // What is not stop-safe yet is still on the node.
            if (reply.waiting.empty() || !self->state.tasks.find(task))
              go_on();
            else
              self->state.pending.waiters[task].gone.push_back(go_on);
          },
          [=](const caf::error& why) {
            call_off_transfer(self, id, to_failure(why));
          });
}

void reschedule_tasks(coordinator_pointer self, const std::string& id,
                      const std::function<void()>& next) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  const auto node = x->row.node;
  const auto tasks = st.deployments.tasks_bound_to(node);
  move_tasks(self, node, tasks, [=](const completion& moved) {
    auto* open = self->state.transfers.find_open(id);
    if (!open)
      return;
    if (!moved)
      return call_off_transfer(self, id, moved.error());
    open->rescheduled = tasks;
    next();
  });
}

} // namespace

void clear_instances(coordinator_pointer self, const std::string& id,
                     instance_policy policy,
                     const std::function<void()>& next) {
  auto& st = self->state;
  const auto* x = st.transfers.find_open(id);
  if (!x)
    return;
  const auto node = x->row.node;
  auto tasks = st.deployments.tasks_bound_to(node);
  if (tasks.empty() || policy == instance_policy::refuse)
    return next();
  if (policy == instance_policy::terminate)
    return terminate_tasks(self, id, std::move(tasks), next);
  // What is being deployed cannot be moved before it runs.
  after_deployments_on(self, node, [=] { reschedule_tasks(self, id, next); });
}

} // namespace roscell
