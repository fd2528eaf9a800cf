#include "tools/roscell/view/columns.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli {

namespace {

/// How many of a task's instances run, and since when some are not known.
std::string running_text(const std::vector<instance_row>& rows,
                         const view_style& style) {
  size_t running = 0;
  int64_t unknown = 0;
  int64_t since = 0;
  for (const auto& row : rows) {
    if (!is_unknown(row)) {
      running += row.state == instance_state::running ? 1 : 0;
      continue;
    }
    ++unknown;
    since = since == 0 ? row.unknown_since_unix_ms
                       : std::min(since, row.unknown_since_unix_ms);
  }
  auto result = std::to_string(running) + "/" + std::to_string(rows.size());
  if (unknown > 0)
    result += ", " + std::to_string(unknown) + " unknown since "
              + format_since(since, style.now_unix_ms);
  return result;
}

/// For what the steps of a task wait: "arm/grasp waits to be stop-safe, 12 s".
std::string waits_of(const task_row& task, const view_style& style) {
  std::vector<std::string> words;
  for (const auto& row : task.instances) {
    const auto name = row.spec.task + "/" + row.spec.step;
    if (row.unsafe_since_unix_ms != 0 && !is_unknown(row))
      words.push_back(name + " " + not_stop_safe_text(row, style.now_unix_ms));
    else if (!row.waits.empty())
      words.push_back(
          name + " " + row.waits
          + (is_unknown(row) ? ", away for " + since_text(row, style) : ""));
  }
  return joined(words, "; ");
}

/// Why a step does not simply run; what it waits for stands beside its task.
std::string step_remark(const instance_row& row, int64_t now_unix_ms) {
  const bool has_finished =
      row.state == instance_state::stopped && row.exit_code == 0;
  return runs_well(row) || has_finished ? "" : remark(row, now_unix_ms);
}

/// What the steps of a task say that run and do not do well: "rectify: 118
/// frames in, none out". What is wrong with others follows from the state.
std::string text_of_running(const task_row& task, const view_style& style) {
  std::vector<std::string> words;
  for (const auto& row : task.instances)
    if (row.state == instance_state::running && !is_unknown(row)
        && !runs_well(row))
      words.push_back(row.spec.step + ": " + remark(row, style.now_unix_ms));
  return joined(words, "; ");
}

std::string nodes_of(const task_row& task) {
  std::set<std::string> nodes;
  for (const auto& x : task.instances)
    nodes.insert(x.node);
  return listed(nodes);
}

} // namespace

const column_list<task_row>& task_columns() {
  using row = const task_row&;
  using how = const view_style&;
  static const column_list<task_row> result{
      {{"TASK"}, [](row x, how) -> cell { return x.task; }, "key", "/task"},
      {{"STATE"},
       [](row x, how) -> cell { return to_string(x.state); },
       "state",
       "/state"},
      {{"AGE", align::right, 2},
       [](row x, how y) -> cell {
         return format_since(x.submitted_unix_ms, y.now_unix_ms);
       },
       "since",
       "/submitted_unix_ms"},
      {{"RUNNING", align::right},
       [](row x, how y) -> cell { return running_text(x.instances, y); },
       "running"},
      {{"NODES", align::left, 1},
       [](row x, how) -> cell { return nodes_of(x); },
       "nodes"},
      {{"TOOK", align::right, 2, false, true},
       [](row x, how) -> cell {
         return x.ended_unix_ms > 0
                    ? format_since(x.submitted_unix_ms, x.ended_unix_ms)
                    : "";
       }},
      {{"WAITS", align::left, 1, false, true},
       [](row x, how y) -> cell { return waits_of(x, y); }},
      {{"REMARK", align::left, 1, false, true},
       [](row x, how y) -> cell { return text_of_running(x, y); }},
  };
  return result;
}

std::string tasks_view(const task_description& tasks, const view_style& style) {
  return or_nothing(table_of(task_columns(), tasks.tasks, style), "tasks",
                    style);
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
                     [](const instance_row& x, const view_style& y) -> cell {
                       return step_remark(x, y.now_unix_ms);
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
