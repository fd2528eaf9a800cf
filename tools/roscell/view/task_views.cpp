#include "tools/roscell/view/views.hpp"

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

} // namespace

std::string tasks_view(const task_description& tasks, const view_style& style) {
  table t{{{"TASK"},
           {"STATE"},
           {"AGE", align::right, 2},
           {"RUNNING", align::right},
           {"NODES", align::left, 1}},
          {}};
  bool any_ended = false;
  bool any_waits = false;
  bool any_words = false;
  for (const auto& row : tasks.tasks) {
    const auto waits = waits_of(row, style);
    const auto words = text_of_running(row, style);
    any_words = any_words || !words.empty();
    any_ended = any_ended || row.ended_unix_ms > 0;
    any_waits = any_waits || !waits.empty();
    std::set<std::string> nodes;
    for (const auto& i : row.instances)
      nodes.insert(i.node);
    t.rows.push_back({row.task, to_string(row.state),
                      format_since(row.submitted_unix_ms, style.now_unix_ms),
                      running_text(row.instances, style), listed(nodes),
                      row.ended_unix_ms > 0 ? format_since(
                          row.submitted_unix_ms, row.ended_unix_ms)
                                            : "",
                      waits, words});
  }
  // The cells of a row are cut to the number of columns.
  if (any_ended || any_waits || any_words)
    t.columns.push_back({"TOOK", align::right, 2});
  if (any_waits || any_words)
    t.columns.push_back({"WAITS", align::left, 1});
  if (any_words)
    t.columns.push_back({"REMARK", align::left, 1});
  return or_nothing(t, "tasks", style);
}

std::string task_view(const task_description& tasks, const view_style& style) {
  table t{{{"STEP"},
           {"NODE", align::left, 3},
           {"STATE"},
           {"RATE", align::right, 1},
           {"DROPPED", align::right, 2},
           {"LATENCY", align::right, 1},
           {"DATA AGE", align::right}},
          {}};
  double oldest_ms = -1;
  bool any_remark = false;
  for (const auto& task : tasks.tasks)
    for (const auto& row : task.instances) {
      const auto& x = row.metrics;
      const auto words = step_remark(row, style.now_unix_ms);
      oldest_ms = std::max(oldest_ms, x.age_ms);
      any_remark = any_remark || !words.empty();
      t.rows.push_back({row.spec.step, row.node, state_text(row),
                        number_with_unit(x.rate_hz, 1, " Hz"),
                        count_text(x.dropped),
                        number_with_unit(x.latency_ms, 2, " ms"),
                        number_with_unit(x.age_ms, 1, " ms"), words});
    }
  // The cells of a row are cut to the number of columns.
  if (any_remark)
    t.columns.push_back({"REMARK", align::left, 1});
  auto text = tasks_view(tasks, style);
  if (!t.rows.empty())
    text += "\n" + t.render(style.text);
  if (oldest_ms >= 0)
    text += "\nfrom a sensor's stamp to the last output: "
            + format_number(oldest_ms, 1) + " ms (median)\n";
  return text;
}

} // namespace roscell::cli
