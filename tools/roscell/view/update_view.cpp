#include "tools/roscell/view/update_view.hpp"

#include "actors/builds/limits.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

namespace roscell::cli {

namespace {

std::string why_of(const std::vector<std::string>& reasons) {
  return joined(reasons, "; ");
}

void add_task_row(table& to, const task_update_plan& x) {
  if (x.outcome == update_outcome::next_run)
    to.rows.push_back({x.task, "", "next run", "", "",
                       "it has ended, and its request is another one"});
  else if (!x.reasons.empty())
    to.rows.push_back({x.task, "", "changes", "", "", why_of(x.reasons)});
}

/// The steps of a request by their ids, each as it is written.
std::map<std::string, json> steps_in(const task_revision& x) {
  std::map<std::string, json> result;
  const auto request = json::parse(x.request, nullptr, false);
  if (!request.is_object() || !request.contains("pipeline"))
    return result;
  for (const auto& step : request["pipeline"])
    if (step.is_object())
      result[step.value("id", "")] = step;
  return result;
}

/// What of a revision is not as it was before: names of steps.
std::vector<std::string> changed_steps(const task_revision& before,
                                       const task_revision& now) {
  const auto old_steps = steps_in(before);
  const auto new_steps = steps_in(now);
  std::set<std::string> names;
  for (const auto& [name, step] : new_steps) {
    const auto old = old_steps.find(name);
    if (old == old_steps.end() || old->second != step)
      names.insert(name);
  }
  for (const auto& [name, step] : old_steps)
    if (new_steps.count(name) == 0)
      names.insert(name);
  for (const auto& [name, build] : now.builds) {
    const auto old = before.builds.find(name);
    if (old != before.builds.end() && old->second != build)
      names.insert(name);
  }
  return {names.begin(), names.end()};
}

} // namespace

std::string changes_view(const std::vector<task_update_plan>& tasks,
                         const text_style& style) {
  table t{{{"TASK"},
           {"STEP"},
           {"ACTION"},
           {"FROM", align::left, 3},
           {"TO", align::left, 3},
           {"WHY", align::left, 1}},
          {}};
  for (const auto& task : tasks) {
    add_task_row(t, task);
    for (const auto& x : task.changes)
      t.rows.push_back({task.task, x.step, std::string{to_word(x.action)},
                        x.from, x.to, why_of(x.reasons)});
  }
  return t.rows.empty() ? "" : t.render(style);
}

std::string set_changes_view(const std::vector<task_set_plan>& sets,
                             const text_style& style) {
  table t{{{"SET"},
           {"NODE"},
           {"TASK", align::left, 2},
           {"ACTION"},
           {"WHY", align::left, 1}},
          {}};
  for (const auto& set : sets) {
    if (set.changes.empty())
      t.rows.push_back({set.task, "", "", "",
                        "it is for no node yet; one that comes gets it"});
    for (const auto& x : set.changes)
      if (x.action != set_action::stays || !x.reason.empty())
        t.rows.push_back({set.task, x.node, x.task,
                          std::string{to_word(x.action)}, x.reason});
  }
  return t.rows.empty() ? "" : t.render(style);
}

std::string revisions_view(const task_revisions& task, const text_style& style,
                           int64_t now_unix_ms) {
  table t{{{"REVISION", align::right},
           {"SINCE", align::right},
           {"STEPS", align::right},
           {"CHANGED", align::left, 1},
           {"BUILDS", align::left, 2}},
          {}};
  for (size_t i = 0; i < task.revisions.size(); ++i) {
    const auto& x = task.revisions[i];
    std::vector<std::string> builds;
    for (const auto& [step, hash] : x.builds)
      builds.push_back(step + "="
                       + hash.substr(0, limits::build::shown_digits));
    const bool is_last = i + 1 == task.revisions.size();
    t.rows.push_back(
        {std::to_string(x.revision) + (is_last ? " (now)" : ""),
         format_since(x.since_unix_ms, now_unix_ms),
         std::to_string(steps_in(x).size()),
         i == 0 ? "" : joined(changed_steps(task.revisions[i - 1], x), ", "),
         joined(builds)});
  }
  return t.render(style);
}

} // namespace roscell::cli
