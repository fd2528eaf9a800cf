#include "actors/cell/tasks/task_move.hpp"

#include "actors/cell/tasks/cell_resources.hpp"
#include "actors/cell/tasks/cell_tasks.hpp"
#include "actors/cell/tasks/move_stages.hpp"
#include "actors/cell/tasks/task_turns.hpp"
#include "actors/house/limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "messages/failure.hpp"
#include "schemas/decode.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <utility>
#include <variant>

namespace roscell {

namespace {

std::optional<task_request> request_of(const task_entry& entry) {
  auto decoded = decode<task_request>(json::parse(entry.request));
  if (auto* request = std::get_if<task_request>(&decoded))
    return std::move(*request);
  return std::nullopt;
}

/// The steps of a task that run on the node, resolved anew: the node's own
/// version of a skill may be leaving with it.
std::optional<failure> add_steps(coordinator_pointer self, task_move& move,
                                 const std::string& task) {
  const auto& st = self->state;
  const auto request = request_of(*st.tasks.find(task));
  if (!request)
    return failure{error_code::internal,
                   "task '" + task + "' has no request any more"};
  for (const auto& x : st.deployments.of_task(task)) {
    const auto step =
        std::find_if(request->pipeline.begin(), request->pipeline.end(),
                     [&](const auto& y) { return y.id == x.spec.step; });
    if (x.node != move.node || x.end || step == request->pipeline.end())
      continue;
    auto resolved = resolve_steps(
        {*step}, {st.registry.skills(""), st.registry.refused_skills()});
    if (auto* why = std::get_if<failure>(&resolved))
      return *why;
    moved_step moved;
    moved.task = task;
    moved.change.old_instance = x.spec.instance;
    moved.step = std::move(std::get<0>(resolved).front());
    move.steps.push_back(std::move(moved));
  }
  return std::nullopt;
}

/// What has been terminated or has ended meanwhile needs no place any more.
void drop_outdated_steps(const cell_coordinator_state& st, task_move& move) {
  auto& steps = move.steps;
  steps.erase(std::remove_if(steps.begin(), steps.end(),
                             [&](const auto& x) {
                               const auto* old = st.deployments.find(
                                   x.change.old_instance, move.node);
                               return !st.tasks.is_running(x.task) || !old
                                      || old->end;
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
                       "node '" + node + "' has no room: " + why, "/node",
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
  allocate_task question{move->node, {}, std::move(nodes)};
  for (size_t i = 0; i < move->steps.size(); ++i) {
    question.steps.push_back(move->steps[i].step);
    question.steps.back().step.id += "." + std::to_string(i);
  }
  self->request(self->state.setup.scheduler, limits::local::answer, question)
      .then(
          [self, move](const task_plan& plan) { adopt_plan(self, move, plan); },
          [self, move](const caf::error& err) {
            auto why = to_failure(err);
            why.message = "the instances of node '" + move->node
                          + "' do not fit on the other members: " + why.message;
            fail_move(self, move, why);
          });
}

void begin_move(coordinator_pointer self, const move_ptr& move) {
  const auto& st = self->state;
  for (const auto& task : move->tasks)
    if (st.tasks.is_running(task))
      if (auto why = add_steps(self, *move, task))
        return fail_move(self, move, *why);
  if (move->steps.empty()) {
    end_turn(self, move->turn);
    return move->done(nullptr);
  }
  collect_resources_of_cell(self, [self, move](cell_resources&& found) {
    place_steps(self, move, std::move(found.nodes));
  });
}

} // namespace

void move_tasks(coordinator_pointer self, const std::string& node,
                const std::vector<std::string>& tasks,
                const std::function<void(const failure*)>& done) {
  auto move = std::make_shared<task_move>();
  move->node = node;
  move->tasks = tasks;
  move->done = done;
  take_turn(self, caf::actor_addr{}, [self, move](uint64_t turn) {
    move->turn = turn;
    begin_move(self, move);
  });
}

} // namespace roscell
