#include "actors/cell/moves/moved_steps.hpp"

#include "actors/placement/reading/wiring.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "schemas/decode.hpp"

#include <algorithm>
#include <utility>
#include <variant>

namespace roscell {

namespace {

std::vector<std::string> only(const std::vector<std::string>& nodes,
                              const std::string& wanted) {
  const bool has = std::find(nodes.begin(), nodes.end(), wanted) != nodes.end();
  return has ? std::vector<std::string>{wanted} : std::vector<std::string>{};
}

/// The step of an instance as it is written, with the ends that it has.
std::optional<task_step> step_of(const task_request& request,
                                 const deployment& old) {
  const auto found =
      std::find_if(request.pipeline.begin(), request.pipeline.end(),
                   [&](const auto& x) { return x.id == old.spec.step; });
  if (found == request.pipeline.end())
    return std::nullopt;
  auto result = *found;
  // Short forms stay what they were read as.
  result.input = old.spec.input;
  result.output = old.spec.output;
  return result;
}

std::variant<std::vector<resolved_step>, failure>
resolve(const cell_coordinator_state& st, const task_step& step) {
  return resolve_steps({step},
                       {st.registry.skills(""), st.registry.refused_skills()});
}

} // namespace

task_question still_of(const task_move& move) {
  return move.kind == move_kind::restarted ? &task_table::is_kept
                                           : &task_table::is_running;
}

void add_problem(const move_ptr& move, failure why) {
  if (!move->problem)
    move->problem = std::move(why);
}

void end_part(coordinator_pointer self, const move_ptr& move,
              move_stage_handler next, move_stage_handler otherwise) {
  if (--move->open > 0)
    return;
  (move->problem ? otherwise : next)(self, move);
}

std::optional<task_request> request_of(const task_entry& entry) {
  const auto document = json::parse(entry.request, nullptr, false);
  if (document.is_discarded())
    return std::nullopt;
  auto decoded = decode<task_request>(document);
  if (auto* request = std::get_if<task_request>(&decoded))
    return std::move(*request);
  return std::nullopt;
}

failure without_request(const std::string& task) {
  return {error_code::internal,
          "the record of task '" + task + "' is damaged: it has no request",
          "/task", "terminate the task, and run it again"};
}

std::optional<failure> add_moved_step(coordinator_pointer self, task_move& move,
                                      const task_request& request,
                                      const deployment& old,
                                      const std::string& only_on) {
  const auto written = step_of(request, old);
  if (!written)
    return std::nullopt;
  auto resolved = resolve(self->state, *written);
  if (auto* why = std::get_if<failure>(&resolved))
    return *why;
  moved_step moved;
  moved.task = request.task;
  moved.from = old.node;
  const auto* node = self->state.registry.find_name(old.node);
  moved.was_there = node && node->agent;
  moved.change.old_instance = old.spec.instance;
  moved.step = std::move(std::get<0>(resolved).front());
  if (!only_on.empty())
    for (auto& build : moved.step.builds)
      build.nodes = only(build.nodes, only_on);
  move.steps.push_back(std::move(moved));
  return std::nullopt;
}

std::optional<resolved_step> resolve_anew(const cell_coordinator_state& st,
                                          const task_request& request,
                                          const deployment& old) {
  const auto written = step_of(request, old);
  if (!written)
    return std::nullopt;
  auto resolved = resolve(st, *written);
  if (auto* steps = std::get_if<std::vector<resolved_step>>(&resolved))
    return std::move(steps->front());
  return std::nullopt;
}

void bind_together(const std::string& task, std::vector<resolved_step>& steps) {
  std::vector<written_step> written;
  written.reserve(steps.size());
  for (const auto& x : steps)
    written.push_back(as_written(x.step));
  const auto together = find_wiring(task, written, {}).together;
  for (size_t i = 0; i < steps.size(); ++i)
    steps[i].together = together[i];
}

void keep_together(task_move& move) {
  std::map<std::string, std::vector<size_t>> by_task;
  for (size_t i = 0; i < move.steps.size(); ++i)
    by_task[move.steps[i].task].push_back(i);
  uint64_t groups = 0;
  for (const auto& [task, members] : by_task) {
    std::vector<resolved_step> of_task;
    for (const auto i : members)
      of_task.push_back(move.steps[i].step);
    bind_together(task, of_task);
    for (size_t k = 0; k < members.size(); ++k) {
      const auto number = of_task[k].together;
      move.steps[members[k]].step.together = number == 0 ? 0 : groups + number;
    }
    groups += members.size();
  }
}

} // namespace roscell
