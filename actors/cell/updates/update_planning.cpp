#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/updates/update_run.hpp"
#include "actors/core/ros2_setting.hpp"
#include "actors/placement/questions/search_problem.hpp"
#include "actors/placement/reading/task_reading.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace roscell {

namespace {

/// What the task has, but for what takes another one's place.
std::vector<deployment> placed_of(const cell_coordinator_state& st,
                                  const std::string& task) {
  auto result = st.deployments.of_task(task);
  result.erase(std::remove_if(result.begin(), result.end(),
                              [](const auto& x) { return x.tentative; }),
               result.end());
  return result;
}

/// The pipeline as it is read: with the builds that its steps have now, if
/// these are to be kept.
std::vector<task_step> pipeline_to_read(const update_run& run,
                                        const std::vector<deployment>& placed) {
  auto result = run.request.pipeline;
  if (!run.asked.keep_builds)
    return result;
  for (auto& step : result)
    for (const auto& x : placed)
      if (x.spec.step == step.id && step.build.empty()
          && x.spec.operation == step.operation && x.spec.model == step.model)
        step.build = x.spec.skill;
  return result;
}

std::variant<task_reading, failure>
read_request(const cell_coordinator_state& st, const update_run& run,
             const std::vector<deployment>& placed) {
  const auto pipeline = pipeline_to_read(run, placed);
  reading_context cell{skills_within_reach(st), written_in(st), {}};
  if (st.setup.graph)
    cell.topics = written_topics(*st.setup.graph);
  auto result = read_task(run.request.task, pipeline, cell);
  if (auto* reading = std::get_if<task_reading>(&result))
    for (size_t i = 0; i < reading->steps.size(); ++i)
      reading->steps[i].step.build = run.request.pipeline[i].build;
  return result;
}

update_question question_of(const cell_coordinator_state& st,
                            const update_run& run,
                            std::vector<deployment> placed,
                            std::vector<resolved_step> steps) {
  update_question result;
  for (const auto& x : placed) {
    const auto* node = st.registry.find_name(x.node);
    if (node && is_away(st, x.node))
      result.away.insert(x.node);
    if (node)
      result.labels[x.node] = labels_of(node->row.resources);
  }
  for (const auto& [name, value] : st.setup.environment)
    result.cell_environment.insert(name);
  result.cell_environment.insert(ros2_setting_variable);
  result.restart_all = run.asked.restart_all;
  result.placed = std::move(placed);
  result.steps = std::move(steps);
  return result;
}

/// Why an instance that is to end cannot be told so.
std::optional<failure> why_not_ended(const cell_coordinator_state& st,
                                     const deployment& x) {
  if (x.end)
    return std::nullopt;
  if (auto why = why_not_ordered(st, x.spec.instance))
    return why;
  if (!is_away(st, x.node) || !st.registry.find_name(x.node))
    return std::nullopt;
  return failure{error_code::conflict,
                 "node '" + x.node + "' is away, so step '" + x.spec.step
                     + "' cannot be replaced",
                 "/task", "wait for the node, or stop the task"};
}

void add_request_reasons(const cell_coordinator_state& st, update_run& run) {
  const auto& entry = *st.tasks.find(task_of(run));
  auto& reasons = run.plan.reasons;
  if (const auto before = request_of(entry))
    reasons = compare_requests(*before, run.request);
  else
    reasons = {"what it was asked for before cannot be read"};
  if (run.body != entry.request && run.plan.is_empty())
    reasons.emplace_back("its steps are written in another way");
}

} // namespace

const std::string& task_of(const update_run& run) {
  return run.request.task;
}

std::optional<failure> plan_changes(coordinator_pointer self, update_run& run) {
  const auto& st = self->state;
  if (auto why = why_busy(st, task_of(run)))
    return why;
  auto placed = placed_of(st, task_of(run));
  auto read = read_request(st, run, placed);
  if (auto* why = std::get_if<failure>(&read))
    return std::move(*why);
  auto& reading = std::get<task_reading>(read);
  run.plan = compare_steps(
      question_of(st, run, std::move(placed), std::move(reading.steps)));
  run.plan.warnings = std::move(reading.warnings);
  add_request_reasons(st, run);
  for (const auto& x : run.plan.steps)
    if (x.is_fresh() && x.old)
      if (auto why = why_not_ended(st, *x.old))
        return why;
  for (const auto& x : run.plan.dropped)
    if (auto why = why_not_ended(st, x))
      return why;
  return std::nullopt;
}

task_update_plan report_of(const cell_coordinator_state& st,
                           const update_run& run, update_outcome outcome) {
  const auto* entry = st.tasks.find(task_of(run));
  task_update_plan result;
  result.task = task_of(run);
  result.outcome = outcome;
  const auto revision = entry ? entry->revisions.revision : 1;
  const bool is_same =
      outcome == update_outcome::unchanged || outcome == update_outcome::ended;
  result.revision = is_same ? revision : revision + 1;
  result.changes = run.plan.changes();
  result.reasons = run.plan.reasons;
  result.warnings = run.plan.warnings;
  return result;
}

} // namespace roscell
