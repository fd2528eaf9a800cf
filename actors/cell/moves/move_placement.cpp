#include "actors/cell/moves/move_stages.hpp"

#include "actors/cell/tasks/cell_resources.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/tasks/task_turns.hpp"
#include "actors/house/limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/reading/wiring.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "messages/failure.hpp"
#include "schemas/decode.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

namespace roscell {

namespace {

std::vector<std::string> only(const std::vector<std::string>& nodes,
                              const std::string& wanted) {
  const bool has = std::find(nodes.begin(), nodes.end(), wanted) != nodes.end();
  return has ? std::vector<std::string>{wanted} : std::vector<std::string>{};
}

/// Steps of a task that share files go to one node together.
void keep_together(const task_move& move, std::vector<resolved_step>& steps) {
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
      steps[members[k]].together = number == 0 ? 0 : groups + number;
    }
    groups += members.size();
  }
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

/// What has been terminated or has ended meanwhile needs no place any more.
void drop_outdated_steps(const cell_coordinator_state& st, task_move& move) {
  auto& steps = move.steps;
  steps.erase(std::remove_if(steps.begin(), steps.end(),
                             [&](const auto& x) {
                               const auto* old = st.deployments.find(
                                   x.change.old_instance, x.from);
                               const bool ran = move.kind == move_kind::leaving;
                               return !(st.tasks.*still_of(move))(x.task)
                                      || !old || (ran && old->end);
                             }),
              steps.end());
}

instance_spec spec_of(const cell_coordinator_state& st, const moved_step& x) {
  allocated_task alone;
  alone.request.task = x.task;
  alone.steps = {x.step};
  alone.plan.allocations = {x.change.place};
  auto result = make_specs(alone).front();
  complete_spec(st, result);
  return result;
}

/// One request a node and task: a repeated one replaces the one before.
std::map<std::string, std::vector<instance_reservation>>
reservations_of(const task_move& move) {
  std::map<std::string, std::vector<instance_reservation>> result;
  for (const auto& x : move.steps) {
    auto& wishes = result[x.change.place.node];
    if (wishes.empty() || wishes.back().task != x.task)
      wishes.push_back({x.task, {}});
    wishes.back().specs.push_back(x.change.spec);
  }
  return result;
}

void reserve_room(coordinator_pointer self, const move_ptr& move,
                  const std::string& node, const instance_reservation& wish) {
  const auto* entry = self->state.registry.find_name(node);
  auto end_with = [self, move, node](const std::string& why) {
    add_problem(move, {error_code::no_feasible_allocation,
                       "node '" + node + "' has no room: " + why, "",
                       "the nodes' resources change; try it again"});
    end_part(self, move, hold_steps, undo_move);
  };
  if (!entry || entry->row.state != row_state::active)
    return end_with("it left meanwhile");
  self->request(entry->agent, limits::task::reservation, wish)
      .then(
          [self, move, end_with](const instances_reserved& reply) {
            if (!reply.refused.empty())
              return end_with(reply.refused.front().reason);
            end_part(self, move, hold_steps, undo_move);
          },
          [end_with](const caf::error& why) {
            end_with(to_failure(why).message);
          });
}

void reserve_steps(coordinator_pointer self, const move_ptr& move) {
  const auto wishes = reservations_of(*move);
  move->open = 1;
  for (const auto& [node, list] : wishes)
    move->open += list.size();
  for (const auto& [node, list] : wishes)
    for (const auto& wish : list)
      reserve_room(self, move, node, wish);
  end_part(self, move, hold_steps, undo_move);
}

void adopt_plan(coordinator_pointer self, const move_ptr& move,
                const task_plan& plan) {
  auto& st = self->state;
  for (size_t i = 0; i < move->steps.size(); ++i) {
    auto& x = move->steps[i];
    x.change.place = plan.allocations[i];
    // Numbered for the scheduler, which wants them unique.
    x.change.place.step = x.step.step.id;
    x.change.spec = spec_of(st, x);
  }
  drop_outdated_steps(st, *move);
  if (move->steps.empty()) {
    end_turn(self, move->turn);
    return move->done(nullptr);
  }
  reserve_steps(self, move);
}

void place_steps(coordinator_pointer self, const move_ptr& move,
                 std::vector<node_resources> nodes) {
  allocate_task question{move->what, {}, std::move(nodes)};
  for (size_t i = 0; i < move->steps.size(); ++i) {
    question.steps.push_back(move->steps[i].step);
    question.steps.back().step.id += "." + std::to_string(i);
  }
  keep_together(*move, question.steps);
  self->request(self->state.setup.scheduler, limits::local::answer, question)
      .then(
          [self, move](const task_plan& plan) { adopt_plan(self, move, plan); },
          [self, move](const caf::error& err) {
            auto why = to_failure(err);
            why.message = move->what + " do not fit: " + why.message;
            fail_move(self, move, why);
          });
}

} // namespace

std::optional<task_request> request_of(const task_entry& entry) {
  auto decoded = decode<task_request>(json::parse(entry.request));
  if (auto* request = std::get_if<task_request>(&decoded))
    return std::move(*request);
  return std::nullopt;
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
  moved.was_there = !is_away(self->state, old.node);
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

void place_move(coordinator_pointer self, const move_ptr& move) {
  if (move->steps.empty()) {
    end_turn(self, move->turn);
    return move->done(nullptr);
  }
  collect_resources_of_cell(self, [self, move](cell_resources&& found) {
    place_steps(self, move, std::move(found.nodes));
  });
}

} // namespace roscell
