#include "tools/roscell/tasks/task_view.hpp"

#include "tools/roscell/view/format.hpp"

namespace roscell::cli {

namespace {

std::string placed_view(const std::vector<placed_instance>& instances,
                        const text_style& style) {
  table t{{{"STEP"}, {"NODE"}, {"INSTANCE"}}, {}};
  for (const auto& x : instances)
    t.rows.push_back({x.step, x.node, x.instance});
  return t.render(style);
}

} // namespace

namespace {

/// What has become of a task by the request, or was so before.
std::string found_text(const task_accepted& task) {
  switch (task.found) {
  case task_found::started:
    return " runs";
  case task_found::anew:
    return " runs once more, run " + std::to_string(task.run);
  case task_found::running:
    return task.healed.empty() ? " runs already" : " runs";
  case task_found::degraded:
    return " is degraded";
  case task_found::finished:
    return " has finished, and was asked for by this request_id or by none: a "
           "new one starts it once more";
  case task_found::failed:
    break;
  }
  return " has failed, and was asked for by this request_id: a new one starts "
         "it once more";
}

} // namespace

std::string accepted_view(const task_accepted& task, const text_style& style) {
  auto text = "task " + printable(task.task) + found_text(task);
  if (!task.optimal)
    text += ", maybe not where it would be best";
  text += "\n\n" + placed_view(task.instances, style);
  if (!task.healed.empty())
    text += "\nstarted again: " + printable(joined(task.healed, ", ")) + "\n";
  for (const auto& x : task.preempted)
    text += "\npreempted: " + printable(x.task + "/" + x.step + " on " + x.node)
            + "\n";
  return text;
}

std::string restarted_view(const task_restarted& task,
                           const text_style& style) {
  return "task " + printable(task.task) + ": started again\n\n"
         + placed_view(task.instances, style);
}

std::string waiting_text(const safety_wait& wait) {
  return printable("waits for '" + wait.task + "/" + wait.step + "' on "
                   + wait.node + " to be stop-safe");
}

std::string terminated_view(const task_terminated& task) {
  const auto count = task.instances.size();
  auto text = "task " + printable(task.task) + " is gone, with "
              + std::to_string(count)
              + (count == 1 ? " instance\n" : " instances\n");
  if (!task.waiting.empty())
    text = "task " + printable(task.task) + " is ending\n";
  for (const auto& wait : task.waiting)
    text += waiting_text(wait) + "\n";
  if (!task.pending_nodes.empty())
    text += "away, to remove theirs when they are back: "
            + printable(joined(task.pending_nodes, ", ")) + "\n";
  return text;
}

} // namespace roscell::cli
