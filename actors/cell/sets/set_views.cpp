#include "actors/cell/sets/cell_sets.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/placement/questions/search_problem.hpp"

#include <algorithm>

namespace roscell {

namespace {

/// What an earlier run of the coordinator has known of a member says nothing of
/// its labels.
bool has_reported_labels(const registry_entry& x) {
  return !x.row.resources.architecture.empty();
}

std::map<std::string, set_node>
nodes_for_sets(const cell_coordinator_state& st) {
  std::map<std::string, set_node> result;
  for (const auto& row : st.registry.rows()) {
    const auto* entry = st.registry.find_uuid(row.identity.uuid);
    if (!entry || row.state == row_state::reserved
        || row.state == row_state::departing)
      continue;
    set_node x;
    x.labels = labels_of(row.resources);
    x.labels["node"] = row.identity.name;
    x.is_unknown = !has_reported_labels(*entry);
    x.is_away = is_away(st, row.identity.name);
    x.is_draining = is_draining(st, *entry);
    result[row.identity.name] = std::move(x);
  }
  return result;
}

set_task task_for_sets(const cell_coordinator_state& st,
                       const std::string& name, const task_entry& entry,
                       const std::string& run) {
  set_task x;
  x.set = entry.set;
  x.body = entry.request;
  x.is_ending = entry.ending;
  x.is_busy =
      entry.state == task_state::deploying || st.updates.is_updating(name);
  x.is_settled = is_settled(entry.state);
  x.is_of_run = st.tasks.is_of_run(name, run);
  for (const auto& placed : st.deployments.of_task(name))
    x.nodes.insert(placed.node);
  x.update_problem = entry.update.problem;
  return x;
}

bool is_well(const cell_coordinator_state& st, const std::string& task) {
  const auto* entry = st.tasks.find(task);
  if (!entry)
    return false;
  const auto state = state_of_task(st, task, *entry);
  return state == task_state::running || state == task_state::finished;
}

} // namespace

std::vector<set_step> plan_of_set(const cell_coordinator_state& st,
                                  const set_table::entry& set) {
  const auto& record = set.record;
  set_question question;
  question.request = set.request;
  question.stopped = {record.stopped.begin(), record.stopped.end()};
  question.nodes = nodes_for_sets(st);
  const auto prefix = task_name(record.task, "");
  for (const auto& [name, entry] : st.tasks.entries())
    if (name.compare(0, prefix.size(), prefix) == 0)
      question.tasks[name] =
          task_for_sets(st, name, entry, run_id(record, name));
  return plan_set(question, *set.tasks);
}

task_set_row describe_set(const cell_coordinator_state& st,
                          const std::string& set) {
  const auto* known = st.sets.find(set);
  return known ? describe_set(st, set, plan_of_set(st, *known))
               : task_set_row{};
}

task_set_row describe_set(const cell_coordinator_state& st,
                          const std::string& set,
                          const std::vector<set_step>& steps) {
  task_set_row result;
  const auto* known = st.sets.find(set);
  if (!known)
    return result;
  result.task = set;
  result.submitted_unix_ms = known->record.submitted_unix_ms;
  result.labels = known->request.for_each.node.labels;
  result.stopped = known->record.stopped;
  const auto put_back_on = st.sets.put_back_on(set, steps);
  for (const auto& x : steps) {
    result.nodes += x.is_wanted ? 1 : 0;
    auto problem = st.sets.problem(set, x);
    if (problem.empty() && !put_back_on.empty()
        && x.change.action == set_action::changes)
      problem = "waits, for the change on '" + put_back_on + "' was put back";
    const bool is_done =
        x.change.action == set_action::stays && problem.empty();
    result.pending += is_done ? 0 : 1;
    result.running += is_done && is_well(st, x.change.task) ? 1 : 0;
    if (!problem.empty())
      result.problems.push_back({x.change.node, problem});
  }
  return result;
}

} // namespace roscell
