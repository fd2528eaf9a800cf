#include "tools/roscell/client/ask_cell.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli {

known_cell ask_for_cell(const node_client& node) {
  known_cell result;
  result.asked = node.get("/v1/node").get<node_description>();
  result.cell = result.asked.role == node_role::coordinator
                    ? node.get("/v1/cell").get<cell_description>()
                    : cell_around(result.asked);
  result.instances =
      node.get("/v1/instances").get<instance_description>().instances;
  result.skills = node.get("/v1/skills").get<skill_list>();
  result.events = kept_events_of(node);
  return result;
}

std::vector<instance_row> instances_in_cell(const node_client& node) {
  std::vector<instance_row> result;
  try {
    const auto known = node.get("/v1/tasks").get<task_description>();
    for (const auto& task : known.tasks)
      result.insert(result.end(), task.instances.begin(), task.instances.end());
  } catch (const refused&) {
    // A node in no cell has told all that it knows.
  }
  return result;
}

bool add_cell_of_member(const node_client& node, known_cell& known) {
  if (known.asked.role == node_role::coordinator || known.asked.cell.empty())
    return false;
  try {
    known.cell = node.get("/v1/cell").get<cell_description>();
  } catch (const refused&) {
    return false;
  }
  for (auto& row : instances_in_cell(node))
    if (std::none_of(known.instances.begin(), known.instances.end(),
                     [&](const auto& x) {
                       return x.spec.instance == row.spec.instance;
                     }))
      known.instances.push_back(std::move(row));
  return true;
}

} // namespace roscell::cli
