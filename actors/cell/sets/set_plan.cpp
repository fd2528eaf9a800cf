#include "actors/cell/sets/set_plan.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

/// "patrol-r1" of "patrol" was made for "r1".
std::string node_of(const std::string& set, const std::string& task) {
  const auto prefix = task_name(set, "");
  return task.compare(0, prefix.size(), prefix) == 0
             ? task.substr(prefix.size())
             : std::string{};
}

set_action action_for(const set_task& task, const std::string& body) {
  const bool differs = task.body != body;
  if (task.is_settled)
    return differs || !task.is_of_run ? set_action::runs : set_action::stays;
  return differs ? set_action::changes : set_action::stays;
}

void compare_task(set_step& x, const set_question& question,
                  const set_node& node) {
  const auto found = question.tasks.find(x.change.task);
  if (found == question.tasks.end()) {
    x.change.action = set_action::starts;
    x.is_held = node.is_away;
    return;
  }
  const auto& task = found->second;
  if (task.set != question.request.task) {
    x.problem = "there is a task '" + x.change.task
                + "' that is not of this set; stop it, or give the set "
                  "another name";
    return;
  }
  x.change.action = action_for(task, x.task->body);
  x.joins = x.change.action == set_action::stays && !task.is_of_run;
  x.is_held = node.is_away || task.is_ending || task.is_busy;
  x.put_back = task.update_problem;
}

set_step step_for_node(const set_question& question, const std::string& name,
                       const set_node& node, node_tasks& tasks) {
  set_step result;
  result.change.node = name;
  result.change.task = task_name(question.request.task, name);
  result.task = tasks.of(question.request, name);
  result.problem = result.task->problem;
  if (result.problem.empty())
    compare_task(result, question, node);
  return result;
}

std::string why_unwanted(const set_question& question,
                         const std::string& node) {
  if (question.stopped.count(node) > 0)
    return "somebody has stopped it";
  const auto found = question.nodes.find(node);
  if (found == question.nodes.end())
    return "the cell has no node '" + node + "' any more";
  if (found->second.is_draining)
    return "node '" + node + "' is being drained";
  return "node '" + node + "' does not have the labels";
}

set_step step_for_unwanted(const set_question& question,
                           const std::string& task, const set_task& known) {
  const auto node = node_of(question.request.task, task);
  set_step result;
  result.change = {node, task, set_action::stops, why_unwanted(question, node)};
  result.is_wanted = false;
  result.is_held = known.is_ending;
  return result;
}

} // namespace

bool is_for(const task_set_request& set, const set_node& node) {
  const auto& wanted = set.for_each.node.labels;
  return !node.is_draining
         && std::all_of(wanted.begin(), wanted.end(), [&](const auto& label) {
              const auto found = node.labels.find(label.first);
              return found != node.labels.end()
                     && found->second == label.second;
            });
}

std::vector<set_step> plan_set(const set_question& question,
                               node_tasks& tasks) {
  tasks.keep_within(2 * question.nodes.size());
  const auto& set = question.request.task;
  std::vector<set_step> result;
  std::set<std::string> wanted;
  for (const auto& [name, node] : question.nodes)
    if (node.is_unknown) {
      wanted.insert(task_name(set, name));
    } else if (is_for(question.request, node)
               && question.stopped.count(name) == 0) {
      result.push_back(step_for_node(question, name, node, tasks));
      wanted.insert(result.back().change.task);
    }
  // A node that has got another name runs what it had under the former one, and
  // the two would share its devices and topics.
  std::set<std::string> occupied;
  for (const auto& [name, task] : question.tasks)
    if (task.set == set && wanted.count(name) == 0) {
      result.push_back(step_for_unwanted(question, name, task));
      occupied.insert(task.nodes.begin(), task.nodes.end());
    }
  for (auto& x : result)
    if (x.change.action == set_action::starts
        && occupied.count(x.change.node) > 0)
      x.is_held = true;
  return result;
}

} // namespace roscell
