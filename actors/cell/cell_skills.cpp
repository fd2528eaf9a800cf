#include "actors/cell/cell_members.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/core/skill_changes.hpp"
#include "messages/event_kinds.hpp"

namespace roscell {

namespace {

void publish_build(const cell_coordinator_state& st, const event_kind& what,
                   const std::string& node, const installed_skill& skill) {
  st.context.publish_event(
      what, skill.descriptor.operation,
      {{"node", node}, {"hash", skill.hash}, {"version", skill.version}});
}

/// What has had no place may have one now, and need not wait until it is tried
/// again.
void try_waiting_steps(coordinator_pointer self) {
  auto& st = self->state;
  const auto now = self->clock().now();
  st.failures.hurry(now);
  st.orders.hurry(now);
  st.drains.hurry(now);
  wake(self);
}

/// A node tells of its skills when it has got other settings, too, and sets of
/// tasks go by its labels. Meanwhile it may have gone.
void ask_for_labels(coordinator_pointer self, const registry_entry& entry) {
  if (self->state.sets.size() == 0 || !entry.agent)
    return;
  self->request(entry.agent, limits::resource::collection, resource_query{})
      .then(
          [self, uuid = entry.row.identity.uuid](const resource_report& x) {
            if (auto* known = self->state.registry.find_uuid(uuid)) {
              known->row.resources.labels = x.resources.labels;
              look_at_sets(self);
            }
          },
          // The next placement asks it again.
          [](const caf::error&) {});
}

void take_skills(coordinator_pointer self, registry_entry& entry,
                 const skills_changed& now) {
  entry.skills = now.skills;
  entry.refused_skills = now.refused_skills;
  try_waiting_steps(self);
  ask_for_labels(self, entry);
  look_at_sets(self);
}

} // namespace

void on_skills_changed(coordinator_pointer self,
                       const member_skills_changed& event) {
  auto& st = self->state;
  auto* entry = st.registry.find_member(event.uuid, event.member);
  if (!entry)
    return;
  const auto changes = changes_between(entry->skills, event.now.skills);
  const auto& node = entry->row.identity.name;
  for (const auto& x : changes.removed)
    publish_build(st, events::skill_removed, node, x);
  for (const auto& x : changes.added)
    publish_build(st, events::skill_added, node, x);
  take_skills(self, *entry, event.now);
}

void on_own_skills_changed(coordinator_pointer self,
                           const skills_changed& now) {
  auto& st = self->state;
  // Its events are the node's own.
  if (auto* own = st.registry.find_uuid(st.setup.self.uuid))
    take_skills(self, *own, now);
}

} // namespace roscell
