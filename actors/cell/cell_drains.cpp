#include "actors/cell/cell_drains.hpp"

#include "actors/cell/moves/task_move.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/house/wall_clock.hpp"
#include "messages/failure.hpp"

namespace roscell {

namespace {

caf::error unknown_node(const std::string& node) {
  return fail(error_code::unknown_node, "this cell has no node '" + node + "'",
              "/node", "`roscell nodes` lists them");
}

std::vector<std::string> left_on(const cell_coordinator_state& st,
                                 const std::string& node) {
  std::vector<std::string> result;
  for (const auto& spec : st.deployments.bound_to(node))
    result.push_back(spec.instance);
  return result;
}

node_drained progress_of(const cell_coordinator_state& st,
                         const drained_node& x) {
  return {x.record.node, left_on(st, x.record.node), x.trouble};
}

void on_moved(coordinator_pointer self, const drain_record& drain,
              const failure* why) {
  auto& st = self->state;
  const auto* known = st.drains.find(drain.uuid);
  if (!known)
    return;
  const auto left = left_on(st, drain.node);
  if (why && known->trouble != why->message)
    st.context.tell("node_drain_stuck", drain.node,
                    {{"reason", why->message}, {"left", left}});
  if (left.empty())
    st.context.tell("node_drained", drain.node);
  st.drains.end(drain.uuid, why ? why->message : "", left.empty(),
                self->clock().now());
  set_timer(self);
}

/// What a node that is away runs may not be started elsewhere: nobody knows
/// whether it runs on.
bool is_there(const cell_coordinator_state& st, const std::string& uuid) {
  const auto* entry = st.registry.find_uuid(uuid);
  return entry && entry->agent;
}

/// What is being deployed cannot be moved before it runs.
void move_away(coordinator_pointer self, const drain_record& drain) {
  self->state.drains.begin(drain.uuid);
  if (!is_there(self->state, drain.uuid)) {
    const failure away{error_code::conflict, "the node is away"};
    return on_moved(self, drain, &away);
  }
  after_deployments_on(self, drain.node, [self, drain] {
    const auto tasks = self->state.deployments.tasks_bound_to(drain.node);
    move_tasks(self, drain.node, tasks, [self, drain](const failure* why) {
      on_moved(self, drain, why);
    });
  });
}

} // namespace

void restore_drains(coordinator_pointer self) {
  for (const auto& x : self->state.setup.drains)
    self->state.drains.add(x, self->clock().now());
}

caf::result<node_drained> drain_node(coordinator_pointer self,
                                     const node_drain& request) {
  auto& st = self->state;
  const auto* entry = st.registry.find_name(request.node);
  if (!entry)
    return unknown_node(request.node);
  const auto uuid = entry->row.identity.uuid;
  if (request.force)
    force_removals_on(self, request.node);
  if (const auto* known = st.drains.find(uuid))
    return progress_of(st, *known);
  const drain_record record{request.node, uuid, unix_now_ms()};
  auto promise = self->make_response_promise<node_drained>();
  keep_records(
      self, {{"drains", uuid, json(record).dump()}},
      [self, record, promise]() mutable {
        auto& state = self->state;
        if (state.drains.add(record, self->clock().now()))
          state.context.tell("node_draining", record.node,
                             {{"left", left_on(state, record.node)}});
        go_on_draining(self);
        promise.deliver(progress_of(state, *state.drains.find(record.uuid)));
      },
      [promise](const failure& why) mutable {
        promise.deliver(to_error(why));
      });
  return promise;
}

caf::result<node_undrained> undrain_node(coordinator_pointer self,
                                         const node_undrain& request) {
  auto& st = self->state;
  const auto* entry = st.registry.find_name(request.node);
  if (!entry)
    return unknown_node(request.node);
  const auto uuid = entry->row.identity.uuid;
  if (!st.drains.find(uuid))
    return node_undrained{request.node};
  auto promise = self->make_response_promise<node_undrained>();
  keep_records(
      self, {{"drains", uuid, ""}},
      [self, uuid, node = request.node, promise]() mutable {
        self->state.drains.forget(uuid);
        self->state.context.tell("node_undrained", node);
        promise.deliver(node_undrained{node});
      },
      [promise](const failure& why) mutable {
        promise.deliver(to_error(why));
      });
  return promise;
}

void go_on_draining(coordinator_pointer self) {
  auto& st = self->state;
  for (const auto& x : st.drains.due(self->clock().now()))
    move_away(self, x);
}

bool is_draining(const cell_coordinator_state& st, const registry_entry& node) {
  return st.drains.find(node.row.identity.uuid) != nullptr;
}

} // namespace roscell
