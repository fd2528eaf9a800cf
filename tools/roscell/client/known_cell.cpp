#include "tools/roscell/client/known_cell.hpp"

#include "schemas/closest_word.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli {

namespace {

/// Of those whose kind fits.
template <class Predicate>
std::vector<known_thing> those(const std::vector<known_thing>& all,
                               const std::string& kind, Predicate&& has_name) {
  std::vector<known_thing> result;
  for (const auto& x : all)
    if ((kind.empty() || to_string(x.kind) == kind) && has_name(x))
      result.push_back(x);
  return result;
}

[[noreturn]] void refuse_ambiguous(const std::vector<known_thing>& found,
                                   const std::string& name) {
  std::set<std::string> words;
  for (const auto& x : found)
    words.insert(to_string(x.kind) + " " + x.name);
  if (words.size() == 1)
    throw command_error{exit_usage, "several nodes are called '" + name + "'",
                        "`roscell nodes` shows their addresses; start one of "
                        "them with another --name"};
  throw command_error{exit_usage, "several things are called '" + name + "'",
                      "say which one: "
                          + joined({words.begin(), words.end()}, ", ")};
}

[[noreturn]] void refuse_unknown(const std::vector<known_thing>& all,
                                 const std::string& kind,
                                 const std::string& name) {
  std::vector<std::string_view> names;
  for (const auto& x : all)
    if (kind.empty() || to_string(x.kind) == kind)
      names.push_back(x.name);
  const std::string near{closest_word(name, names)};
  throw command_error{exit_refused,
                      "there is no "
                          + (kind.empty() ? "node, task, instance, "
                                            "skill or cell"
                                          : kind)
                          + " '" + name + "'",
                      near.empty() ? "" : "did you mean '" + near + "'?"};
}

} // namespace

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

known_thing find_thing(const known_cell& known, const std::string& kind,
                       const std::string& name) {
  const auto all = things_of(known);
  auto found = those(all, kind, [&](const auto& x) { return x.name == name; });
  if (found.empty() && !name.empty())
    found = those(all, kind, [&](const auto& x) {
      return x.kind == thing_kind::instance
             && x.name.compare(0, name.size(), name) == 0;
    });
  if (found.empty())
    refuse_unknown(all, kind, name);
  if (found.size() > 1)
    refuse_ambiguous(found, name);
  return found.front();
}

} // namespace roscell::cli
