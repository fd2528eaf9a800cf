#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "client/value_text.hpp"

#include <algorithm>
#include <set>

namespace roscell {

namespace {

/// How many of a task's instances run, and since when some are not known.
std::string running_text(const std::vector<instance_row>& rows,
                         int64_t now_unix_ms) {
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
              + format_since(since, now_unix_ms);
  return result;
}

/// For what the steps of a task wait: "arm/grasp waits to be stop-safe, 12 s".
std::string waits_of(const task_row& task, int64_t now_unix_ms) {
  std::vector<std::string> words;
  for (const auto& row : task.instances) {
    const auto name = row.spec.task + "/" + row.spec.step;
    if (row.unsafe_since_unix_ms != 0 && !is_unknown(row))
      words.push_back(name + " " + not_stop_safe_text(row, now_unix_ms));
    else if (!row.waits.empty())
      words.push_back(name + " " + row.waits
                      + (is_unknown(row)
                             ? ", away for " + since_text(row, now_unix_ms)
                             : ""));
  }
  return joined(words, "; ");
}

/// How far a task's update is, and what its steps say that run and do not do
/// well: "rectify: 118 frames in, none out". What is wrong with others follows
/// from the state.
std::string text_of_running(const task_row& task, int64_t now_unix_ms) {
  std::vector<std::string> words;
  if (!task.updating.empty())
    words.push_back("is being updated, " + task.updating);
  for (const auto& row : task.instances)
    if (row.state == instance_state::running && !is_unknown(row)
        && !runs_well(row))
      words.push_back(row.spec.step + ": " + remark(row, now_unix_ms));
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
  using now = int64_t;
  static const column_list<task_row> result{
      {{"TASK"},
       [](row x, now) -> column_value { return x.task; },
       "key",
       "/task"},
      {{"STATE"},
       [](row x, now) -> column_value { return to_string(x.state); },
       "state",
       "/state"},
      {{"AGE", align::right, 2},
       [](row x, now y) -> column_value {
         return format_since(x.submitted_unix_ms, y);
       },
       "since",
       "/submitted_unix_ms"},
      {{"RUNNING", align::right},
       [](row x, now y) -> column_value {
         return running_text(x.instances, y);
       },
       "running"},
      {{"NODES", align::left, 1},
       [](row x, now) -> column_value { return nodes_of(x); },
       "nodes"},
      {{"TOOK", align::right, 2, false, true},
       [](row x, now) -> column_value {
         return x.ended_unix_ms > 0
                    ? format_since(x.submitted_unix_ms, x.ended_unix_ms)
                    : "";
       }},
      {{"WAITS", align::left, 1, false, true},
       [](row x, now y) -> column_value { return waits_of(x, y); }},
      {{"REMARK", align::left, 1, false, true},
       [](row x, now y) -> column_value { return text_of_running(x, y); }},
  };
  return result;
}

} // namespace roscell
