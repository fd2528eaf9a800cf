#include "tools/roscell/top/layout/things.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli::top {

namespace {

bool runs(const instance_row& row) {
  return !is_unknown(row) && row.state == instance_state::running;
}

/// The first step that does not simply run, and why.
std::string remark_of(const task_row& task, int64_t now_unix_ms) {
  for (const auto& row : task.instances) {
    const bool is_well = runs_well(row) && row.waits.empty();
    const bool has_finished =
        row.state == instance_state::stopped && row.exit_code == 0;
    if (is_well || has_finished)
      continue;
    const auto why = remark(row, now_unix_ms);
    return row.spec.step + " " + state_text(row)
           + (why.empty() ? "" : ": " + why);
  }
  return {};
}

item task_item(const task_row& task, int64_t now_unix_ms) {
  std::set<std::string> nodes;
  for (const auto& row : task.instances)
    nodes.insert(row.node);
  const auto running =
      std::count_if(task.instances.begin(), task.instances.end(), runs);
  const auto state = to_string(task.state);
  item result;
  result.id = task.task;
  result.cells = {
      {task.task},
      {state, look_of_state(state)},
      {std::to_string(running) + "/" + std::to_string(task.instances.size())},
      {format_since(task.submitted_unix_ms, now_unix_ms)},
      {listed(nodes)},
      {remark_of(task, now_unix_ms)}};
  return result;
}

item instance_item(const instance_row& row, int64_t now_unix_ms) {
  const auto& x = row.metrics;
  const auto state = state_text(row);
  const auto since =
      is_unknown(row) ? row.unknown_since_unix_ms : row.since_unix_ms;
  item result;
  result.id = row.spec.instance;
  result.cells = {
      {row.spec.task},
      {row.spec.step},
      {row.node},
      {state, look_of_state(state)},
      {number_with_unit(x.rate_hz, 1, " Hz")},
      {number_with_unit(x.latency_ms, 1, " ms")},
      {count_text(x.dropped), x.dropped > 0 ? look::busy : look::plain},
      {std::to_string(row.restarts),
       row.restarts > 0 ? look::busy : look::plain},
      {memory_text(row), takes_too_much(row) ? look::busy : look::plain},
      {cpu_text(row)},
      {format_since(since, now_unix_ms)},
      {remark(row, now_unix_ms)},
      {count_text(x.frames)},
      {row.spec.instance}};
  return result;
}

} // namespace

listing list_tasks(const known_cell& known, int64_t now_unix_ms) {
  listing result;
  result.columns = {{"TASK"},
                    {"STATE"},
                    {"RUNNING", align::right, 1},
                    {"AGE", align::right, 2},
                    {"NODES", align::left, 3},
                    {"REMARK", align::left, 4}};
  for (const auto& task : known.cell.tasks)
    result.items.push_back(task_item(task, now_unix_ms));
  return result;
}

listing list_instances(const known_cell& known, int64_t now_unix_ms) {
  listing result;
  result.columns = {{"INSTANCE OF"},
                    {"STEP"},
                    {"NODE", align::left, 1},
                    {"STATE"},
                    {"RATE", align::right, 1},
                    {"LATENCY", align::right, 2},
                    {"DROPS", align::right, 3},
                    {"RESTARTS", align::right, 3},
                    {"MEMORY", align::right, 3},
                    {"CPU", align::right, 3},
                    {"SINCE", align::right, 5},
                    {"REMARK", align::left, 4},
                    {"FRAMES", align::right, 6},
                    {"ID", align::left, 7, true}};
  for (const auto& row : known.instances)
    result.items.push_back(instance_item(row, now_unix_ms));
  return result;
}

} // namespace roscell::cli::top
