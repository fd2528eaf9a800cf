#include "actors/cell/tables/deployment_table.hpp"

#include "actors/cell/limits.hpp"
#include "messages/codec/instantiate.hpp"

#include <algorithm>
#include <string_view>
#include <utility>

namespace roscell {

ROSCELL_CODEC(instance_end)

void deployment_table::place(const std::string& task,
                             std::vector<deployment> steps) {
  const auto before = std::exchange(by_task_[task], std::move(steps));
  for (const auto& x : before) {
    const auto* row = reported(x.node, x.spec.instance);
    if (row && !is_live(row->state) && !find(x.spec.instance, x.node))
      forget_reported(x.node, x.spec.instance);
    if (!find(x.spec.instance))
      ignored_ends_.erase(x.spec.instance);
  }
}

void deployment_table::forget_task(const std::string& task) {
  for (const auto& x : of_task(task)) {
    forget_reported(x.node, x.spec.instance);
    ignored_ends_.erase(x.spec.instance);
  }
  by_task_.erase(task);
}

const std::vector<deployment>&
deployment_table::of_task(const std::string& task) const {
  static const std::vector<deployment> none;
  const auto i = by_task_.find(task);
  return i == by_task_.end() ? none : i->second;
}

const deployment* deployment_table::find(const std::string& instance) const {
  for (const auto& [task, steps] : by_task_)
    for (const auto& x : steps)
      if (x.spec.instance == instance)
        return &x;
  return nullptr;
}

const deployment* deployment_table::find(const std::string& instance,
                                         const std::string& node) const {
  const auto* known = find(instance);
  return known && known->node == node ? known : nullptr;
}

std::vector<instance_spec>
deployment_table::bound_to(const std::string& node) const {
  std::vector<instance_spec> result;
  for (const auto& [task, steps] : by_task_)
    for (const auto& x : steps)
      if (x.node == node && !x.end)
        result.push_back(x.spec);
  return result;
}

std::vector<std::string>
deployment_table::tasks_bound_to(const std::string& node) const {
  std::vector<std::string> result;
  for (const auto& spec : bound_to(node))
    if (result.empty() || result.back() != spec.task)
      result.push_back(spec.task);
  return result;
}

std::vector<instance_spec>
deployment_table::untold_on(const std::string& node) const {
  auto result = bound_to(node);
  result.erase(
      std::remove_if(result.begin(), result.end(),
                     [&](const auto& x) { return reported(node, x.instance); }),
      result.end());
  return result;
}

bool deployment_table::note_row(const std::string& node, instance_row row) {
  auto& rows = reported_[node];
  const auto id = row.spec.instance;
  if (rows.count(id) == 0 && rows.size() >= limits::instance::reported)
    return false;
  row.node = node;
  rows[id] = std::move(row);
  return true;
}

void deployment_table::note_all_rows(const std::string& node,
                                     const std::vector<instance_row>& rows) {
  reported_.erase(node);
  for (const auto& row : rows)
    note_row(node, row);
}

void deployment_table::note_status_texts(
    const std::string& node, const std::vector<instance_status_text>& texts) {
  const auto known = reported_.find(node);
  if (known == reported_.end())
    return;
  auto& rows = known->second;
  for (auto& [id, row] : rows)
    if (is_live(row.state))
      row.metrics = {};
  for (const auto& word : texts) {
    const auto row = rows.find(word.instance);
    if (row == rows.end() || !is_live(row->second.state))
      continue;
    row->second.metrics = word.metrics;
    // While an image is built, the node has told the step of it.
    if (!word.status.empty())
      row->second.status = word.status;
  }
}

void deployment_table::forget_reported(const std::string& node,
                                       const std::string& instance) {
  const auto rows = reported_.find(node);
  if (rows == reported_.end())
    return;
  rows->second.erase(instance);
  if (rows->second.empty())
    reported_.erase(rows);
}

void deployment_table::forget_node(const std::string& node) {
  reported_.erase(node);
}

std::set<std::string> deployment_table::rename_node(const std::string& from,
                                                    const std::string& to) {
  std::set<std::string> result;
  for (auto& [task, steps] : by_task_)
    for (auto& x : steps)
      if (x.node == from) {
        x.node = to;
        result.insert(task);
      }
  if (auto rows = reported_.extract(from)) {
    for (auto& [instance, row] : rows.mapped())
      row.node = to;
    rows.key() = to;
    reported_.insert(std::move(rows));
  }
  return result;
}

const instance_row*
deployment_table::reported(const std::string& node,
                           const std::string& instance) const {
  const auto rows = reported_.find(node);
  if (rows == reported_.end())
    return nullptr;
  const auto row = rows->second.find(instance);
  return row == rows->second.end() ? nullptr : &row->second;
}

std::set<std::string> deployment_table::nodes_with_live() const {
  std::set<std::string> result;
  for (const auto& [node, rows] : reported_)
    if (std::any_of(rows.begin(), rows.end(),
                    [](const auto& x) { return is_live(x.second.state); }))
      result.insert(node);
  return result;
}

std::vector<const instance_row*> deployment_table::all_reported() const {
  std::vector<const instance_row*> result;
  for (const auto& [node, rows] : reported_)
    for (const auto& [id, row] : rows)
      result.push_back(&row);
  return result;
}

std::vector<instance_row>
deployment_table::rows_on(const std::string& node) const {
  std::vector<instance_row> result;
  if (const auto rows = reported_.find(node); rows != reported_.end())
    for (const auto& [id, row] : rows->second)
      result.push_back(row);
  return result;
}

std::vector<instance_row>
deployment_table::rows_of(const std::string& task) const {
  std::vector<instance_row> result;
  for (const auto& [node, rows] : reported_)
    for (const auto& [id, row] : rows)
      if (row.spec.task == task)
        result.push_back(row);
  return result;
}

template <class OnPlaced, class OnStray>
void deployment_table::visit(const std::string& node, bool untold,
                             OnPlaced&& on_placed, OnStray&& on_stray) const {
  std::set<std::string_view> placed;
  for (const auto& [task, steps] : by_task_)
    for (const auto& x : steps)
      if (x.node == node
          && (untold || x.end || reported(node, x.spec.instance))) {
        on_placed(x);
        placed.insert(x.spec.instance);
      }
  if (const auto rows = reported_.find(node); rows != reported_.end())
    for (const auto& [id, row] : rows->second)
      if (placed.count(id) == 0)
        on_stray(row);
}

std::vector<instance_row> deployment_table::known_on(const std::string& node,
                                                     bool untold) const {
  std::vector<instance_row> result;
  visit(
      node, untold, [&](const auto& x) { result.push_back(row_of(x)); },
      [&](const auto& row) { result.push_back(row); });
  return result;
}

std::vector<instance_measures>
deployment_table::measures_on(const std::string& node, bool untold) const {
  static const instance_row unknown;
  std::vector<instance_measures> result;
  visit(
      node, untold,
      [&](const auto& x) {
        const auto* known = reported(node, x.spec.instance);
        const auto& row = known ? *known : unknown;
        result.push_back({x.spec.instance, x.spec.task, x.spec.step, node,
                          x.end ? x.end->state : row.state, row.restarts,
                          row.metrics, row.health});
      },
      [&](const auto& row) { result.push_back(measures_of(row)); });
  return result;
}

instance_row deployment_table::row_of(const deployment& x) const {
  instance_row result;
  if (const auto* known = reported(x.node, x.spec.instance))
    result = *known;
  // A node keeps little of what ended long ago; the placement knows it all.
  result.spec = x.spec;
  result.node = x.node;
  if (x.end) {
    result.state = x.end->state;
    result.exit_code = x.end->exit_code;
    result.reason = x.end->reason;
    result.since_unix_ms = x.end->unix_ms;
  }
  return result;
}

void deployment_table::ignore_end(const std::string& instance) {
  ignored_ends_.insert(instance);
}

void deployment_table::heed_end(const std::string& instance) {
  ignored_ends_.erase(instance);
}

std::vector<instance_end>
deployment_table::untaken_ends(const std::string& task) const {
  std::vector<instance_end> result;
  for (const auto& x : of_task(task)) {
    const auto* row = reported(x.node, x.spec.instance);
    if (row && !x.end && !is_live(row->state)
        && ignored_ends_.count(x.spec.instance) == 0)
      result.push_back({x.spec.instance, row->state, row->exit_code,
                        row->reason, row->since_unix_ms});
  }
  return result;
}

std::optional<instance_row>
deployment_table::find_row(const std::string& instance) const {
  if (const auto* placed = find(instance))
    return row_of(*placed);
  for (const auto& [node, rows] : reported_)
    if (const auto i = rows.find(instance); i != rows.end())
      return i->second;
  return std::nullopt;
}

} // namespace roscell
