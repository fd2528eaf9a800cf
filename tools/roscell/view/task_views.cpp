#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "client/value_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/views.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// Why a step does not simply run; what it waits for stands beside its task.
std::string step_remark(const instance_row& row, int64_t now_unix_ms) {
  const bool has_finished =
      row.state == instance_state::stopped && row.exit_code == 0;
  return runs_well(row) || has_finished ? "" : remark(row, now_unix_ms);
}

/// What stands in the way of a set: the first of it, and on how many nodes.
std::string set_remark(const task_set_row& x) {
  std::string result;
  if (!x.problems.empty())
    result = x.problems.front().node + ": " + x.problems.front().reason;
  if (x.problems.size() > 1)
    result += " (and " + std::to_string(x.problems.size() - 1) + " more)";
  if (!x.stopped.empty())
    result += (result.empty() ? "" : "; ") + std::string{"stopped on "}
              + joined(x.stopped, ", ");
  return result;
}

std::string labels_text(const std::map<std::string, std::string>& labels) {
  std::vector<std::string> result;
  result.reserve(labels.size());
  for (const auto& [name, value] : labels)
    result.push_back(name + "=" + value);
  return result.empty() ? "all" : joined(result, " ");
}

std::string sets_view(const std::vector<task_set_row>& sets,
                      const view_style& style) {
  table t{{{"SET OF TASKS"},
           {"NODES", align::left, 2},
           {"RUNS ON"},
           {"REMARK", align::left, 1}},
          {}};
  for (const auto& x : sets)
    t.rows.push_back(
        {x.task, labels_text(x.labels),
         std::to_string(x.running) + " of " + std::to_string(x.nodes),
         set_remark(x)});
  return t.render(style.text);
}

} // namespace

std::string tasks_view(const task_description& tasks, const view_style& style) {
  if (tasks.sets.empty())
    return or_nothing(table_of(task_columns(), tasks.tasks, style), "tasks",
                      style);
  const auto sets = sets_view(tasks.sets, style);
  return tasks.tasks.empty()
             ? sets
             : table_of(task_columns(), tasks.tasks, style).render(style.text)
                   + "\n" + sets;
}

std::string task_view(const task_description& tasks, const view_style& style) {
  std::vector<instance_row> steps;
  for (const auto& task : tasks.tasks)
    steps.insert(steps.end(), task.instances.begin(), task.instances.end());
  auto text = tasks_view(tasks, style);
  if (steps.empty())
    return text;
  auto columns = picked(instance_columns(), {{"STEP"},
                                             {"NODE", align::left, 3},
                                             {"STATE"},
                                             {"RATE", align::right, 1},
                                             {"DROPPED", align::right, 2},
                                             {"LATENCY", align::right, 1},
                                             {"DATA AGE", align::right}});
  columns.push_back({{"REMARK", align::left, 1, false, true},
                     [](const instance_row& x, int64_t now_unix_ms) -> cell {
                       return step_remark(x, now_unix_ms);
                     }});
  text += "\n" + table_of(columns, steps, style).render(style.text);
  const auto oldest = std::max_element(
      steps.begin(), steps.end(), [](const auto& x, const auto& y) {
        return x.metrics.age_ms < y.metrics.age_ms;
      });
  if (oldest->metrics.age_ms >= 0)
    text += "\nfrom a sensor's stamp to the last output: "
            + format_number(oldest->metrics.age_ms, 1) + " ms (median)\n";
  return text;
}

} // namespace roscell::cli
