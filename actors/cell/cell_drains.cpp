#include "actors/cell/cell_departures.hpp"

#include "actors/cell/moves/task_move.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/core/clocks.hpp"
#include "actors/core/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace roscell {

namespace {

caf::error unknown_node(const std::string& node) {
  return fail(error_code::unknown_node, "this cell has no node '" + node + "'",
              "/node", "`roscell nodes` lists them");
}

/// A drain outlives the node's row, as it does a restart of the node: it may
/// have been made empty in order to be away for a while.
bool is_gone(const cell_coordinator_state& st, const drain_record& drain) {
  return st.registry.find_uuid(drain.uuid) == nullptr;
}

/// A node may have been renamed since.
std::string name_of(const cell_coordinator_state& st,
                    const drain_record& drain) {
  const auto* entry = st.registry.find_uuid(drain.uuid);
  return entry ? entry->row.identity.name : drain.node;
}

/// Of the node of that name, and of those that had it and are gone.
std::vector<drain_record> drains_of(const cell_coordinator_state& st,
                                    const std::string& node) {
  auto result = st.drains.all();
  result.erase(
      std::remove_if(result.begin(), result.end(),
                     [&](const auto& x) { return name_of(st, x) != node; }),
      result.end());
  return result;
}

caf::error nothing_to_undrain(const cell_coordinator_state& st,
                              const std::string& node) {
  constexpr size_t most_names = 5;
  std::set<std::string> gone;
  for (const auto& x : st.drains.all())
    if (is_gone(st, x) && gone.size() < most_names)
      gone.insert(x.node);
  std::string hint = "`roscell nodes` lists them";
  for (const auto& x : gone)
    hint += (x == *gone.begin() ? "; gone and drained still: " : ", ") + x;
  return fail(error_code::unknown_node,
              "this cell has no node '" + node
                  + "', and none of that name was drained and is gone",
              "/node", hint);
}

/// Makes room for one more: of those that are gone the one that was drained
/// first is forgotten.
void forget_oldest(cell_coordinator_state& st,
                   std::vector<store_record>& records) {
  if (st.drains.size() < limits::cell::drains)
    return;
  for (const auto& x : st.drains.all())
    if (is_gone(st, x)) {
      records.push_back({"drains", x.uuid, ""});
      st.context.publish_event(
          events::node_undrained, x.node,
          {{"reason", "it has been gone for long, and others are "
                      "drained now"}});
      return st.drains.forget(x.uuid);
    }
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
  const auto node = name_of(st, x.record);
  return {node, left_on(st, node), x.problem};
}

void on_moved(coordinator_pointer self, const drain_record& drain,
              const completion& moved) {
  auto& st = self->state;
  const auto* known = st.drains.find(drain.uuid);
  if (!known)
    return;
  const auto node = name_of(st, drain);
  const auto left = left_on(st, node);
  const auto problem = moved ? std::string{} : moved.error().message;
  if (!moved && known->problem != problem)
    st.context.publish_event(events::node_drain_stuck, node,
                             {{"reason", problem}, {"left", left}});
  if (left.empty())
    st.context.publish_event(events::node_drained, node);
  st.drains.end(drain.uuid, problem, left.empty(), self->clock().now());
  set_timer(self);
}

/// What a node that is away runs may not be started elsewhere: it is
/// unknown whether it runs on.
bool is_there(const cell_coordinator_state& st, const std::string& uuid) {
  const auto* entry = st.registry.find_uuid(uuid);
  return entry && entry->agent;
}

void refuse_absent(coordinator_pointer self, const drain_record& drain) {
  on_moved(self, drain, failure{error_code::conflict, "the node is away"});
}

/// What is being deployed cannot be moved before it runs; meanwhile the node
/// may be lost.
void move_away(coordinator_pointer self, const drain_record& drain) {
  self->state.drains.begin(drain.uuid);
  if (!is_there(self->state, drain.uuid))
    return refuse_absent(self, drain);
  const auto node = name_of(self->state, drain);
  after_deployments_on(self, node, [self, drain, node] {
    if (!is_there(self->state, drain.uuid))
      return refuse_absent(self, drain);
    const auto tasks = self->state.deployments.tasks_bound_to(node);
    move_tasks(self, node, tasks, [self, drain](const completion& moved) {
      on_moved(self, drain, moved);
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
  std::vector<store_record> records{{"drains", uuid, json(record).dump()}};
  forget_oldest(st, records);
  keep_records(
      self, records,
      [self, record, promise]() mutable {
        auto& state = self->state;
        if (state.drains.add(record, self->clock().now()))
          state.context.publish_event(events::node_draining, record.node,
                                      {{"left", left_on(state, record.node)}});
        look_at_sets(self);
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
  const auto& st = self->state;
  const auto drains = drains_of(st, request.node);
  if (drains.empty() && !st.registry.find_name(request.node))
    return nothing_to_undrain(st, request.node);
  if (drains.empty())
    return node_undrained{request.node};
  std::vector<store_record> records;
  records.reserve(drains.size());
  for (const auto& x : drains)
    records.push_back({"drains", x.uuid, ""});
  auto promise = self->make_response_promise<node_undrained>();
  keep_records(
      self, records,
      [self, drains, node = request.node, promise]() mutable {
        for (const auto& x : drains)
          self->state.drains.forget(x.uuid);
        look_at_sets(self);
        self->state.context.publish_event(events::node_undrained, node);
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

} // namespace roscell
