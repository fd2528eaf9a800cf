#include "actors/cell/cell_transfers.hpp"

#include "actors/cell/state/coordinator_publish.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/node_whereabouts.hpp"
#include "actors/cell/state/transfer_end.hpp"
#include "actors/cell/task_move.hpp"
#include "actors/house/limits.hpp"
#include "actors/house/wall_clock.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace roscell {

namespace {

using self_pointer = coordinator_pointer;
using time_point = std::chrono::steady_clock::time_point;

/// The node stays a member, and nothing has changed.
void call_off(self_pointer self, const std::string& id, const failure& why) {
  auto& st = self->state;
  auto& x = st.transfers.at(id);
  auto* entry = st.registry.find_uuid(x.row.uuid);
  if (entry && entry->transfer == id) {
    if (entry->member)
      st.registry.stay(*entry, now_of(self));
    else
      st.registry.deactivate(*entry, row_state::lost,
                             "it fell silent while it was to leave",
                             now_of(self));
    publish(self, {x.row.uuid});
  }
  end_transfer(self, x, transfer_state::returned, why.message, &why);
}

std::function<void(const caf::error&)> calling_off(self_pointer self,
                                                   const std::string& id) {
  return [self, id](const caf::error& why) {
    call_off(self, id, to_failure(why));
  };
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
    result.target = {peer->standing.place};
  return result;
}

void on_switch_accepted(self_pointer self, const std::string& id) {
  auto& st = self->state;
  auto& x = st.transfers.at(id);
  // It may be known already where the node is.
  if (!is_open(x.row.state) || !x.row.to.empty())
    return;
  // A released node has written down that it is, so it will not come back.
  on_node_elsewhere(self, x.row.uuid, INT64_MAX, "");
}

/// Nobody knows whether the node has heard that it shall go. Where it registers
/// next tells, so it must not stay in a session that it may believe in.
void ask_where_it_goes(self_pointer self, const std::string& id) {
  auto& st = self->state;
  const auto& x = st.transfers.at(id);
  const auto* entry = st.registry.find_uuid(x.row.uuid);
  if (is_open(x.row.state) && entry && entry->transfer == id && entry->member)
    self->send(entry->member,
               close_session{"it is not known whether the node goes"});
}

void order_switch(self_pointer self, const std::string& id,
                  join_origin origin) {
  auto& st = self->state;
  auto& x = st.transfers.at(id);
  auto* entry = st.registry.find_uuid(x.row.uuid);
  if (!entry || entry->transfer != id || !entry->member)
    return call_off(self, id,
                    {error_code::unreachable,
                     "node '" + x.row.node + "' fell silent", "/node"});
  const auto order = order_for(st, x, *entry, origin);
  if (!x.row.to.empty() && order.target.empty())
    return call_off(self, id,
                    {error_code::unreachable,
                     "the coordinator of cell '" + x.row.to + "' fell silent",
                     "/target"});
  enter_state(x, transfer_state::switching, "");
  x.deadline = self->clock().now() + limits::transfer::arrival;
  store_transfer(self, x.row);
  set_timer(self);
  self->request(entry->member, limits::membership::switching, order)
      .then(
          [self, id](const switch_accepted&) { on_switch_accepted(self, id); },
          [self, id](const caf::error& err) {
            const auto why = to_failure(err);
            if (why.code != error_code::unreachable
                && why.code != error_code::timeout)
              return call_off(self, id, why);
            ask_where_it_goes(self, id);
          });
}

void reserve_target(self_pointer self, const std::string& id,
                    const std::function<void()>& next) {
  auto& st = self->state;
  const auto& x = st.transfers.at(id);
  if (x.row.to.empty())
    return next();
  const auto* entry = st.registry.find_uuid(x.row.uuid);
  const auto* peer = self->state.peers.find_cell(x.row.to);
  if (!entry || !peer)
    return call_off(self, id,
                    {error_code::unreachable,
                     "node or target cell have just gone", "/target"});
  const auto& who = entry->row.identity;
  self->request(peer->actor, limits::session::peer_answer,
                place_reservation{
                    who.name, who.uuid, who.epoch,
                    std::chrono::milliseconds{limits::transfer::place}.count()})
      .then([next](const place_reserved&) { next(); }, calling_off(self, id));
}

std::vector<std::string> tasks_on(const cell_coordinator_state& st,
                                  const std::string& node) {
  std::vector<std::string> result;
  for (const auto& spec : st.tasks.wanted_on(node))
    if (std::find(result.begin(), result.end(), spec.task) == result.end())
      result.push_back(spec.task);
  return result;
}

/// Ends the tasks one after the other, then goes on.
void terminate_tasks(self_pointer self, const std::string& id,
                     std::vector<std::string> tasks,
                     const std::function<void()>& next) {
  if (tasks.empty())
    return next();
  const auto task = tasks.back();
  tasks.pop_back();
  self->request(cell_coordinator_actor{self}, limits::transfer::termination,
                task_termination{task})
      .then(
          [self, id, tasks, task, next](const task_terminated&) {
            self->state.transfers.at(id).terminated.push_back(task);
            terminate_tasks(self, id, tasks, next);
          },
          calling_off(self, id));
}

void clear_instances(self_pointer self, const std::string& id,
                     instance_policy policy,
                     const std::function<void()>& next) {
  auto& st = self->state;
  const auto node = st.transfers.at(id).row.node;
  auto tasks = tasks_on(st, node);
  if (tasks.empty() || policy == instance_policy::refuse)
    return next();
  if (policy == instance_policy::terminate)
    return terminate_tasks(self, id, std::move(tasks), next);
  move_tasks(self, node, tasks, [self, id, tasks, next](const failure* why) {
    if (why)
      return call_off(self, id, *why);
    self->state.transfers.at(id).rescheduled = tasks;
    next();
  });
}

std::string list(const std::vector<instance_spec>& specs) {
  std::string result;
  for (const auto& x : specs)
    result += (result.empty() ? "'" : ", '") + x.instance + "'";
  return result;
}

/// Why the node cannot go, if so.
std::optional<failure> objection(self_pointer self, const transfer_wish& wish,
                                 const registry_entry& entry) {
  auto& st = self->state;
  const auto name = "node '" + wish.node + "'";
  if (entry.row.identity.uuid == st.setup.self.uuid)
    return failure{error_code::conflict,
                   name + " coordinates cell '" + st.setup.cell
                       + "': a coordination node cannot leave its cell",
                   "/node"};
  if (wish.target == st.setup.cell)
    return failure{error_code::conflict,
                   name + " is in cell '" + st.setup.cell + "' already",
                   "/target"};
  if (entry.row.state == row_state::departing
      || entry.row.state == row_state::reserved)
    return failure{
        error_code::conflict,
        name + " is " + std::string{to_word(entry.row.state)}, "/node",
        entry.transfer.empty() ? "wait until it has joined"
                               : "its transfer is '" + entry.transfer + "'"};
  if (!wish.target.empty() && !self->state.peers.find_cell(wish.target))
    return failure{error_code::unknown_cell,
                   "no coordinator of a cell '" + wish.target
                       + "' is within reach",
                   "/target", "`roscell cells` lists them"};
  const auto specs = st.tasks.wanted_on(wish.node);
  if (wish.instances == instance_policy::refuse && !specs.empty())
    return failure{error_code::conflict, name + " runs " + list(specs),
                   "/instances",
                   "say \"terminate\" or \"reschedule\" to let it go"};
  return std::nullopt;
}

cell_transfer& add_transfer(self_pointer self, const transfer_wish& wish,
                            const std::string& uuid) {
  auto& st = self->state;
  transfer_row row;
  row.transfer = st.setup.cell + "-" + std::to_string(st.setup.incarnation)
                 + "-" + std::to_string(++st.last_transfer);
  row.node = wish.node;
  row.uuid = uuid;
  row.from = st.setup.cell;
  row.to = wish.target;
  row.since_unix_ms = unix_now_ms();
  auto& result = st.transfers[row.transfer];
  result.row = std::move(row);
  result.deadline = time_point::max();
  return result;
}

/// Forgets a node that is away: nobody can tell it, so it comes back if it
/// ever wants to.
void release_absent(self_pointer self, const transfer_wish& wish,
                    const std::string& uuid, const transfer_done& done) {
  auto& x = add_transfer(self, wish, uuid);
  x.waiting.push_back(done);
  const auto id = x.row.transfer;
  clear_instances(self, id, wish.instances, [self, id, uuid] {
    on_node_elsewhere(self, uuid, INT64_MAX, "");
    auto& entry = self->state.transfers.at(id);
    end_transfer(self, entry, transfer_state::done,
                 "the node was away and could not be told", nullptr);
  });
}

void refuse(const transfer_done& done, const failure& why) {
  done(cell_transfer{}, &why);
}

failure unknown_node(const std::string& node) {
  return {error_code::unknown_node, "no node '" + node + "' is in any cell",
          "/node", "`roscell nodes` lists those of a cell"};
}

} // namespace

void start_transfer(self_pointer self, const transfer_wish& wish,
                    transfer_done done) {
  auto& st = self->state;
  auto* entry = st.registry.find_name(wish.node);
  if (!entry)
    return refuse(done, unknown_node(wish.node));
  if (auto why = objection(self, wish, *entry))
    return refuse(done, *why);
  const auto uuid = entry->row.identity.uuid;
  if (!entry->member) {
    if (wish.target.empty())
      return release_absent(self, wish, uuid, done);
    return refuse(done, {error_code::unreachable,
                         "node '" + wish.node + "' is "
                             + std::string{to_word(entry->row.state)},
                         "/node", "try again when it is back"});
  }
  auto& x = add_transfer(self, wish, uuid);
  x.waiting.push_back(std::move(done));
  const auto id = x.row.transfer;
  store_transfer(self, x.row);
  st.registry.depart(*entry, id, now_of(self));
  publish(self, {uuid});
  st.context.tell("node_departing", wish.node,
                  {{"transfer", id}, {"to", wish.target}});
  reserve_target(self, id, [self, id, wish] {
    clear_instances(self, id, wish.instances,
                    [self, id, wish] { order_switch(self, id, wish.origin); });
  });
}

caf::result<node_transferred> transfer_node(self_pointer self,
                                            const node_transfer& request) {
  auto& st = self->state;
  auto promise = self->make_response_promise<node_transferred>();
  const auto* peer = st.peers.find_holder(request.node);
  if (!st.registry.find_name(request.node) && peer && !request.forwarded) {
    auto forwarded = request;
    forwarded.forwarded = true;
    self->request(peer->actor, limits::transfer::forwarded, forwarded)
        .then([promise](node_transferred& x) mutable { promise.deliver(x); },
              [promise](caf::error& why) mutable {
                promise.deliver(std::move(why));
              });
    return promise;
  }
  transfer_wish wish{request.node, request.target, request.instances};
  start_transfer(self, wish,
                 [promise](const cell_transfer& x, const failure* why) mutable {
                   if (why)
                     promise.deliver(to_error(*why));
                   else
                     promise.deliver(node_transferred{
                         x.row.node, x.row.from, x.row.to, x.row.transfer,
                         x.terminated, x.rescheduled});
                 });
  return promise;
}

caf::result<node_released> release_node(self_pointer self,
                                        const node_release& request) {
  auto& st = self->state;
  auto promise = self->make_response_promise<node_released>();
  const auto* peer = st.peers.find_holder(request.node);
  if (!st.registry.find_name(request.node) && peer && !request.forwarded) {
    auto forwarded = request;
    forwarded.forwarded = true;
    self->request(peer->actor, limits::transfer::forwarded, forwarded)
        .then([promise](node_released& x) mutable { promise.deliver(x); },
              [promise](caf::error& why) mutable {
                promise.deliver(std::move(why));
              });
    return promise;
  }
  transfer_wish wish{request.node, "", request.instances};
  start_transfer(self, wish,
                 [promise](const cell_transfer& x, const failure* why) mutable {
                   if (why)
                     promise.deliver(to_error(*why));
                   else
                     promise.deliver(node_released{x.row.node, x.row.from,
                                                   x.row.transfer, x.terminated,
                                                   x.rescheduled});
                 });
  return promise;
}

caf::result<transfer_description>
describe_transfers(self_pointer self, const transfer_query& query) {
  transfer_description result;
  for (const auto& [id, x] : self->state.transfers)
    if (query.transfer.empty() || query.transfer == id)
      result.transfers.push_back(x.row);
  if (!query.transfer.empty() && result.transfers.empty())
    return fail(error_code::unknown_task,
                "no transfer '" + query.transfer + "' is remembered",
                "/transfer", "its own coordinator may remember it");
  std::sort(result.transfers.begin(), result.transfers.end(),
            [](const auto& x, const auto& y) {
              return x.since_unix_ms < y.since_unix_ms;
            });
  return result;
}

void restore_transfers(self_pointer self) {
  auto& st = self->state;
  for (const auto& row : st.setup.transfers) {
    auto& x = st.transfers[row.transfer];
    x.row = row;
    x.deadline = time_point::max();
    auto* entry = st.registry.find_uuid(row.uuid);
    if (!entry) {
      // The row is dropped first, when it is known that the node has gone.
      end_transfer(self, x, transfer_state::done, "", nullptr);
      continue;
    }
    entry->transfer = row.transfer;
    enter_state(x, transfer_state::unresolved,
                "the coordinator was started again");
  }
}

void settle_overdue_transfers(self_pointer self) {
  auto& st = self->state;
  for (auto& [id, x] : st.transfers) {
    if (x.deadline > self->clock().now())
      continue;
    x.deadline = time_point::max();
    enter_state(x, transfer_state::unresolved,
                "neither the node nor the other cell has said how it ended");
    store_transfer(self, x.row);
    auto* entry = st.registry.find_uuid(x.row.uuid);
    if (entry && entry->transfer == id && !entry->member)
      entry->row.reason =
          "it left for "
          + (x.row.to.empty() ? "independence" : "cell '" + x.row.to + "'")
          + " and has not been heard of since";
    const failure why{error_code::unresolved,
                      "the transfer '" + id + "' of node '" + x.row.node
                          + "' is not settled yet",
                      "/node",
                      "`roscell transfers` shows how it stands; it resolves "
                      "itself when the parties meet again"};
    tell_waiting(x, &why);
  }
}

} // namespace roscell
