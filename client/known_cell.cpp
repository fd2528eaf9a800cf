#include "client/known_cell.hpp"

#include <set>
#include <utility>

namespace roscell {

cell_description cell_around(const node_description& node) {
  cell_description result;
  result.cell = node.cell;
  result.address = node.coordinator;
  registry_row row;
  row.identity = node.identity;
  row.role = node.role;
  row.state = row_state::active;
  row.resources = node.resources;
  row.instances = node.instances;
  result.nodes.push_back(std::move(row));
  return result;
}

std::vector<known_thing> things_of(const known_cell& known) {
  std::vector<known_thing> result;
  if (!known.cell.cell.empty())
    result.push_back({thing_kind::cell, known.cell.cell});
  for (const auto& x : known.cell.nodes)
    result.push_back({thing_kind::node, x.identity.name});
  for (const auto& x : known.cell.free)
    result.push_back({thing_kind::node, x.name});
  for (const auto& x : known.cell.tasks)
    result.push_back({thing_kind::task, x.task});
  for (const auto& x : known.instances)
    result.push_back({thing_kind::instance, x.spec.instance});
  std::set<std::string> operations;
  for (const auto& x : known.skills.skills)
    if (operations.insert(x.skill.descriptor.operation).second)
      result.push_back({thing_kind::skill, x.skill.descriptor.operation});
  return result;
}

} // namespace roscell
