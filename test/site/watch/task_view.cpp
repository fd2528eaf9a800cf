#include "test/site/watch/task_view.hpp"

namespace roscell::test {

namespace {

/// Whether the node has told that it starts the instance once more.
bool starts_again(const cell_coordinator_state& st, const deployment& x) {
  const auto* row = st.deployments.reported(x.node, x.spec.instance);
  return row && is_live(row->state) && row->state != instance_state::running
         && (row->restarts > 0 || row->state == instance_state::backing_off);
}

} // namespace

std::vector<task_view> tasks_of(const site_party& coordinator) {
  std::vector<task_view> result;
  const auto& st = coordinator.cell_state();
  for (const auto& [task, entry] : st.tasks.entries()) {
    task_view view{
        task, entry.ending ? task_state::terminating : entry.state, {}};
    for (const auto& x : st.deployments.of_task(task))
      view.steps.push_back({x.spec.step, x.spec.instance, x.node,
                            x.end.has_value(), starts_again(st, x)});
    result.push_back(std::move(view));
  }
  return result;
}

size_t instances_shown(const site_party& coordinator) {
  const auto& st = coordinator.cell_state();
  size_t result = 0;
  for (const auto& row : st.registry.rows())
    result += st.deployments.known_on(row.identity.name, true).size();
  return result;
}

bool are_cell(const site_party& coordinator, const site_party& node) {
  if (&coordinator == &node)
    return true;
  if (!coordinator.alive() || !node.alive() || node.coordinates)
    return false;
  const auto& st = node.status();
  const auto* row = coordinator.cell_state().registry.find_uuid(node.uuid);
  return st.state == node_state::member && st.cell == coordinator.cell && row
         && row->row.state == row_state::active;
}

site_party* find_party(const site& place, const std::string& name) {
  for (const auto& x : place.parties)
    if (x->name == name)
      return x.get();
  return nullptr;
}

} // namespace roscell::test
