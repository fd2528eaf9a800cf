#include "actors/cell/tasks/node_names.hpp"

#include "actors/cell/tasks/task_changes.hpp"
#include "messages/event_kinds.hpp"

#include <utility>

namespace roscell {

void rename_node(coordinator_pointer self, const std::string& from,
                 const std::string& to) {
  auto& st = self->state;
  const auto tasks = st.deployments.rename_node(from, to);
  if (const auto* entry = st.registry.find_name(to))
    st.failures.rename_node(entry->row.identity.uuid, to);
  st.context.publish_event(events::node_renamed, to,
                           {{"from", from}, {"tasks", json(tasks)}});
  for (const auto& task : tasks) {
    pending_change change;
    change.still = &task_table::is_kept;
    change.insistent = true;
    change.make = [from, to](task_record record) {
      return with_renamed(std::move(record), from, to);
    };
    change_task(self, task, std::move(change));
  }
}

void follow_own_name(coordinator_pointer self, const node_registration& own) {
  const auto& st = self->state;
  for (const auto& x : own.instances) {
    const auto* placed = st.deployments.find(x.spec.instance);
    if (placed && !st.registry.find_name(placed->node))
      rename_node(self, std::string{placed->node}, own.identity.name);
  }
}

} // namespace roscell
