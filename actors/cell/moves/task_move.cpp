#include "actors/cell/moves/task_move.hpp"

#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/updates/update_guard.hpp"
#include "actors/core/answer_limits.hpp"
#include "actors/placement/instance_specs.hpp"
#include "actors/placement/limits.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <map>
#include <memory>
#include <optional>
#include <utility>

namespace roscell {

namespace {

/// Who has asked for it did not know that the node would fall silent before
/// it had the placement lock.
failure missed_heartbeats_before(const std::string& node) {
  return {error_code::unreachable,
          "node '" + node
              + "' missed its heartbeats before its instances were moved",
          "/node", "send the request again when it is back"};
}

/// Adds a step that is to run elsewhere, or on that node.
std::optional<failure> add_step(coordinator_pointer self, task_move& move,
                                const task_request& request,
                                const deployment& x, const std::string& to) {
  const auto before = move.steps.size();
  auto why = add_moved_step(self, move, request, x, to);
  // Two of them would move the same robot.
  if (move.steps.size() > before)
    move.steps.back().ends_first = x.spec.life.safe_state;
  return why;
}

/// The steps of a task that run on the node, resolved anew: the node's own
/// version of a skill may be leaving with it.
std::optional<failure> add_steps(coordinator_pointer self, task_move& move,
                                 const std::string& task,
                                 const std::string& node) {
  const auto& st = self->state;
  if (auto why = why_updating(st, task))
    return why;
  const auto request = request_of(*st.tasks.find(task));
  if (!request)
    return without_request(task);
  for (const auto& x : st.deployments.of_task(task))
    if (x.node == node && !x.end && !x.tentative)
      if (auto why = add_step(self, move, *request, x, ""))
        return why;
  return std::nullopt;
}

/// The same for one instance, if it still runs.
std::optional<failure> add_instance(coordinator_pointer self, task_move& move,
                                    const std::string& instance,
                                    const std::string& to) {
  const auto& st = self->state;
  const auto* x = st.deployments.find(instance);
  if (!x || x->end || x->tentative || !st.tasks.is_running(x->spec.task))
    return failure{error_code::conflict,
                   "instance '" + instance + "' does not run any more"};
  if (auto why = why_updating(st, x->spec.task))
    return why;
  const auto request = request_of(*st.tasks.find(x->spec.task));
  if (!request)
    return without_request(x->spec.task);
  return add_step(self, move, *request, *x, to);
}

} // namespace

void move_tasks(coordinator_pointer self, const std::string& node,
                const std::vector<std::string>& tasks,
                const completion_handler& done) {
  auto move = std::make_shared<task_move>();
  move->what = "the instances of node '" + node + "'";
  move->done = done;
  const bool was_away = is_away(self->state, node);
  take_placement_lock(self, caf::actor_addr{}, [=](uint64_t placement_lock) {
    move->placement_lock = placement_lock;
    if (!was_away && is_away(self->state, node))
      return fail_move(self, move, missed_heartbeats_before(node));
    for (const auto& task : tasks)
      if (self->state.tasks.is_running(task))
        if (auto why = add_steps(self, *move, task, node))
          return fail_move(self, move, *why);
    run_move(self, move);
  });
}

void move_instance(coordinator_pointer self, const std::string& instance,
                   const std::string& to, bool force,
                   const completion_handler& done) {
  auto move = std::make_shared<task_move>();
  move->what = "instance '" + instance + "'";
  move->force = force;
  move->done = done;
  take_placement_lock(self, caf::actor_addr{},
                      [self, move, instance, to](uint64_t placement_lock) {
                        move->placement_lock = placement_lock;
                        const auto* x = self->state.deployments.find(instance);
                        if (x && is_away(self->state, x->node))
                          return fail_move(self, move,
                                           missed_heartbeats_before(x->node));
                        if (auto why = add_instance(self, *move, instance, to))
                          return fail_move(self, move, *why);
                        run_move(self, move);
                      });
}

namespace {

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
    auto& requests = result[x.change.place.node];
    if (requests.empty() || requests.back().task != x.task)
      requests.push_back({x.task, {}});
    requests.back().specs.push_back(x.change.spec);
  }
  return result;
}

void reserve_room(coordinator_pointer self, const move_ptr& move,
                  move_stage_handler next, const std::string& node,
                  const instance_reservation& request) {
  const auto* entry = self->state.registry.find_name(node);
  auto end_with = [self, move, next, node](const std::string& why) {
    add_problem(move, {error_code::no_feasible_allocation,
                       "node '" + node + "' has no room: " + why, "",
                       "the nodes' resources change; try it again"});
    end_part(self, move, next, undo_move);
  };
  if (!entry || entry->row.state != row_state::active)
    return end_with("it left meanwhile");
  self->request(entry->agent, limits::task::reservation, request)
      .then(
          [self, move, next, end_with](const instances_reserved& reply) {
            if (!reply.refused.empty())
              return end_with(reply.refused.front().reason);
            end_part(self, move, next, undo_move);
          },
          [end_with](const caf::error& why) {
            end_with(to_failure(why).message);
          });
}

void reserve_steps(coordinator_pointer self, const move_ptr& move,
                   move_stage_handler next) {
  const auto requests = reservations_of(*move);
  move->open = 1;
  for (const auto& [node, list] : requests)
    move->open += list.size();
  for (const auto& [node, list] : requests)
    for (const auto& request : list)
      reserve_room(self, move, next, node, request);
  end_part(self, move, next, undo_move);
}

void adopt_plan(coordinator_pointer self, const move_ptr& move,
                move_stage_handler next, const task_plan& plan) {
  auto& st = self->state;
  for (size_t i = 0; i < move->steps.size(); ++i) {
    auto& x = move->steps[i];
    x.change.place = plan.allocations[i];
    // Numbered for the scheduler, which wants them unique.
    x.change.place.step = x.step.step.id;
    x.change.spec = spec_of(st, x);
  }
  drop_outdated_steps(st, *move);
  if (move->steps.empty())
    return end_move(self, move);
  reserve_steps(self, move, next);
}

void place_steps(coordinator_pointer self, const move_ptr& move,
                 move_stage_handler next, std::vector<node_resources> nodes) {
  keep_together(*move);
  allocate_task question{move->what, {}, std::move(nodes)};
  for (size_t i = 0; i < move->steps.size(); ++i) {
    question.steps.push_back(move->steps[i].step);
    question.steps.back().step.id += "." + std::to_string(i);
  }
  self->request(self->state.setup.scheduler, limits::local::answer, question)
      .then([self, move, next](
                const task_plan& plan) { adopt_plan(self, move, next, plan); },
            [self, move](const caf::error& err) {
              auto why = to_failure(err);
              why.message = move->what + " do not fit: " + why.message;
              fail_move(self, move, why);
            });
}

} // namespace

void place_move(coordinator_pointer self, const move_ptr& move,
                move_stage_handler next) {
  if (move->steps.empty())
    return end_move(self, move);
  collect_resources_of_cell(self, [self, move, next](cell_resources&& found) {
    place_steps(self, move, next, std::move(found.nodes));
  });
}

} // namespace roscell
