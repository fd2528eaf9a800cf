#include "tools/roscell/tasks/pruning.hpp"

#include "actors/edge/http/http_target.hpp"
#include "messages/task_set.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <utility>

namespace roscell::cli {

namespace {

std::pair<std::string, std::string> label_in(const std::string& text) {
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw command_error{exit_usage, "--prune '" + printable(text)
                                        + "': expected LABEL=VALUE"};
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// A set in place of its tasks, with their labels.
task_row as_task(const node_client& node, const task_set_row& set) {
  const auto known =
      node.get("/v1/tasks/" + percent_encode(set.task)).get<task_description>();
  task_row result;
  result.task = set.task;
  if (!known.sets.empty())
    result.labels =
        json::parse(known.sets.front().request).get<task_set_request>().labels;
  return result;
}

} // namespace

std::vector<task_row> to_be_pruned(const std::string& wanted,
                                   const node_client& node,
                                   const std::vector<task_file>& files) {
  if (wanted.empty())
    return {};
  const auto [name, value] = label_in(wanted);
  const auto known = node.get("/v1/tasks").get<task_description>();
  std::vector<task_row> result;
  const auto add = [&, name = name, value = value](const task_row& x) {
    const auto label = x.labels.find(name);
    const bool stays =
        label == x.labels.end() || label->second != value
        || std::any_of(files.begin(), files.end(), [&](const auto& file) {
             return file.request().value("task", "") == x.task;
           });
    if (!stays)
      result.push_back(x);
  };
  for (const auto& x : known.tasks)
    if (x.set.empty())
      add(x);
  for (const auto& x : known.sets)
    add(as_task(node, x));
  return result;
}

task_update_plan plan_of_pruned(const task_row& x) {
  task_update_plan result;
  result.task = x.task;
  result.outcome = update_outcome::shown;
  result.revision = x.revision;
  for (const auto& step : x.instances)
    result.changes.push_back({step.spec.step,
                              step_action::stops,
                              step.spec.instance,
                              step.node,
                              "",
                              {"the task is in no file"}});
  return result;
}

} // namespace roscell::cli
