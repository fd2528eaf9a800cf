#include "actors/cell/tasks/placement_locks.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/streams/stream_watch.hpp"
#include "actors/placement/reservation.hpp"

#include <algorithm>
#include <memory>
#include <set>
#include <utility>

namespace roscell {

namespace {

void grant_next_placement_lock(coordinator_pointer self) {
  auto& pending = self->state.pending;
  while (pending.placement_lock == 0 && !pending.waiting.empty()) {
    const auto next = std::move(pending.waiting.front());
    pending.waiting.pop_front();
    pending.placement_lock = next.number;
    next.begin();
  }
}

} // namespace

void take_placement_lock(coordinator_pointer self, const caf::actor_addr& owner,
                         const std::function<void(uint64_t)>& begin) {
  auto& pending = self->state.pending;
  const auto number = ++pending.last_placement_lock;
  pending.waiting.push_back(
      {number, owner, [begin, number] { begin(number); }});
  grant_next_placement_lock(self);
}

void release_placement_lock(coordinator_pointer self, uint64_t number) {
  if (self->state.pending.placement_lock != number)
    return;
  self->state.pending.placement_lock = 0;
  grant_next_placement_lock(self);
}

void leave_line(coordinator_pointer self, const caf::actor_addr& owner) {
  auto& waiting = self->state.pending.waiting;
  waiting.erase(std::remove_if(waiting.begin(), waiting.end(),
                               [&](const auto& x) { return x.owner == owner; }),
                waiting.end());
}

std::vector<deployed_end> written_in(const cell_coordinator_state& st) {
  std::vector<deployed_end> result;
  for (const auto& [task, entry] : st.tasks.entries())
    for (const auto& x : st.deployments.of_task(task))
      if (!x.end && !x.tentative)
        for (const auto& end : x.spec.output)
          result.push_back({task, x.spec.step, x.node, end});
  return result;
}

namespace {

/// Resources of one cell, as the answers come in.
struct resource_tally {
  size_t open = 0;
  std::map<std::string, node_resources> nodes;
  std::function<void(cell_resources&&)> done;
};

/// What runs in the cell, of any priority.
std::vector<evictable_instance> evictable_in(const cell_coordinator_state& st) {
  std::vector<evictable_instance> result;
  for (const auto& [task, entry] : st.tasks.entries()) {
    if (!st.tasks.is_running(task) || st.updates.is_updating(task))
      continue;
    for (const auto& x : st.deployments.of_task(task))
      if (!x.end && !x.tentative && !st.orders.find(x.spec.instance))
        result.push_back(
            {{x.spec.instance, task, x.spec.step, x.node, x.spec.life.priority},
             x.spec.resources,
             x.spec.gpu});
  }
  return result;
}

/// All have answered: what is held in the tables is looked up now.
void complete_tally(coordinator_pointer self, resource_tally& tally) {
  if (--tally.open > 0)
    return;
  const auto& st = self->state;
  cell_resources result;
  result.cell = st.setup.cell;
  result.skills = skills_within_reach(st);
  result.written = written_in(st);
  result.evictable = evictable_in(st);
  if (st.setup.graph)
    result.topics = written_topics(*st.setup.graph);
  for (auto& [name, node] : tally.nodes) {
    const auto* entry = st.registry.find_name(name);
    if (!entry || entry->row.state != row_state::active)
      continue;
    result.nodes.push_back(std::move(node));
    result.agents.push_back(entry->agent);
  }
  tally.done(std::move(result));
}

/// Adds the room that is held for what a node has not told of yet, unless its
/// report counts it as reserved.
void add_held_room(const cell_coordinator_state& st,
                   const std::vector<std::string>& counted,
                   node_resources& node) {
  for (const auto& spec : st.deployments.untold_on(node.name))
    if (std::find(counted.begin(), counted.end(), spec.instance)
        == counted.end())
      reserve(node, spec.resources, spec.gpu);
}

void on_report(coordinator_pointer self, const std::string& uuid,
               resource_report report, resource_tally& tally) {
  auto* entry = self->state.registry.find_uuid(uuid);
  if (entry && entry->row.state == row_state::active) {
    report.resources.name = entry->row.identity.name;
    entry->row.resources = report.resources;
    add_held_room(self->state, report.reserved, report.resources);
    tally.nodes[report.resources.name] = std::move(report.resources);
  }
  complete_tally(self, tally);
}

std::set<std::string> untold_ids(const cell_coordinator_state& st,
                                 const std::string& node) {
  std::set<std::string> result;
  for (const auto& spec : st.deployments.untold_on(node))
    result.insert(spec.instance);
  return result;
}

void ask_for_resources(coordinator_pointer self, const std::string& uuid,
                       const std::shared_ptr<resource_tally>& tally,
                       int rounds) {
  auto* entry = self->state.registry.find_uuid(uuid);
  if (rounds == 0 || !entry || !entry->agent)
    return complete_tally(self, *tally);
  const auto name = entry->row.identity.name;
  const auto before = untold_ids(self->state, name);
  self->request(entry->agent, limits::resource::collection, resource_query{})
      .then(
          [=](resource_report& x) {
            // Nobody knows whether the report counts an instance that came up
            // while it was on its way. The next one does.
            const auto after = untold_ids(self->state, name);
            if (std::includes(after.begin(), after.end(), before.begin(),
                              before.end()))
              on_report(self, uuid, std::move(x), *tally);
            else
              ask_for_resources(self, uuid, tally, rounds - 1);
          },
          [self, tally](const caf::error&) { complete_tally(self, *tally); });
}

} // namespace

void collect_resources_of_cell(
    coordinator_pointer self,
    const std::function<void(cell_resources&&)>& done) {
  auto tally = std::make_shared<resource_tally>();
  tally->done = done;
  std::vector<std::string> uuids;
  self->state.registry.for_each_active([&](registry_entry& entry) {
    if (!is_draining(self->state, entry))
      uuids.push_back(entry.row.identity.uuid);
  });
  tally->open = uuids.size() + 1;
  for (const auto& uuid : uuids)
    ask_for_resources(self, uuid, tally, limits::resource::rounds);
  complete_tally(self, *tally);
}

caf::result<cell_resources> answer_resources(coordinator_pointer self) {
  auto promise = self->make_response_promise<cell_resources>();
  collect_resources_of_cell(self, [promise](cell_resources&& found) mutable {
    promise.deliver(std::move(found));
  });
  return promise;
}

} // namespace roscell
