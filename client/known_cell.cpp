#include "client/known_cell.hpp"

#include "client/instance_text.hpp"
#include "client/value_text.hpp"

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

namespace {

std::string with_reason(std::string text, const std::string& reason) {
  return reason.empty() ? text : std::move(text) + ": " + reason;
}

bool is_away(const registry_row& row) {
  return row.state == row_state::lost || row.state == row_state::expected;
}

bool is_bad(task_state state) {
  return state == task_state::degraded || state == task_state::failed;
}

/// Whether somebody should know why an instance is as it is.
bool is_bad(const instance_row& row) {
  return !is_unknown(row)
         && (row.state == instance_state::failed
             || row.state == instance_state::backing_off
             || row.health != instance_health::good || !row.problem.empty()
             || (row.state == instance_state::running
                 && !row.metrics.remark.empty())
             || row.unsafe_since_unix_ms != 0);
}

} // namespace

std::vector<std::string> problems_of(const known_cell& known,
                                     int64_t now_unix_ms) {
  std::vector<std::string> result;
  for (const auto& row : known.cell.nodes)
    if (is_away(row))
      result.push_back(
          with_reason("node " + row.identity.name + " " + to_string(row.state)
                          + " " + format_since(row.since_unix_ms, now_unix_ms),
                      row.reason));
  for (const auto& row : known.instances)
    if (is_bad(row))
      result.push_back(with_reason(row.spec.task + "/" + row.spec.step + " "
                                       + state_text(row),
                                   remark(row, now_unix_ms)));
  for (const auto& row : known.cell.tasks)
    if (is_bad(row.state))
      result.push_back("task " + row.task + " " + to_string(row.state));
  for (const auto& x : known.asked.joining)
    result.push_back(with_reason("joining " + x.address, x.problem));
  return result;
}

} // namespace roscell
