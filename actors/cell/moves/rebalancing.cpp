#include "actors/cell/moves/task_move.hpp"

#include "actors/cell/limits.hpp"
#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/placement/limits.hpp"
#include "messages/event_kinds.hpp"
#include "messages/failure.hpp"

#include <utility>
#include <vector>

namespace roscell {

namespace {

bool can_move(const cell_coordinator_state& st, const deployment& x) {
  const auto* node = st.registry.find_name(x.node);
  const auto* row = st.deployments.reported(x.node, x.spec.instance);
  return node && node->row.state == row_state::active && !is_draining(st, *node)
         && row && row->state == instance_state::running && !x.end
         && !x.tentative;
}

/// What of a task runs; a step that cannot be resolved any more stays.
void add_running(const cell_coordinator_state& st, const std::string& task,
                 const task_request& request, plan_moves& to) {
  std::vector<resolved_step> steps;
  std::vector<const deployment*> placed;
  for (const auto& x : st.deployments.of_task(task)) {
    if (!can_move(st, x))
      continue;
    if (auto step = resolve_anew(st, request, x)) {
      steps.push_back(std::move(*step));
      placed.push_back(&x);
    }
  }
  bind_together(task, steps);
  for (size_t i = 0; i < steps.size(); ++i) {
    const auto& x = *placed[i];
    to.steps.push_back({x.spec.instance, task, std::move(steps[i]), x.node,
                        x.spec.deployment, x.spec.gpu, x.spec.resources});
  }
}

plan_moves question_of(const cell_coordinator_state& st,
                       const cell_rebalance& request,
                       std::vector<node_resources> nodes) {
  plan_moves result;
  result.nodes = std::move(nodes);
  result.min_gain = request.min_gain;
  result.most_moves = request.most_moves;
  for (const auto& [task, entry] : st.tasks.entries())
    if (st.tasks.is_running(task) && !st.updates.is_updating(task))
      if (const auto known = request_of(entry))
        add_running(st, task, *known, result);
  return result;
}

void end_moves(coordinator_pointer self) {
  const auto& report = self->state.rebalance.report();
  size_t done = 0;
  for (const auto& x : report.moves)
    done += x.state == move_state::done ? 1 : 0;
  json data{{"moves", done}};
  if (!report.problem.empty())
    data["reason"] = report.problem;
  self->state.context.publish_event(events::rebalance_ended,
                                    self->state.setup.cell, data);
}

void fail_moves(coordinator_pointer self, const std::string& problem) {
  self->state.rebalance.fail(problem);
  end_moves(self);
}

/// The instance that has the step's place now.
const deployment* successor_of(const cell_coordinator_state& st,
                               const rebalance_move& move) {
  for (const auto& x : st.deployments.of_task(move.task))
    if (x.spec.step == move.step && x.node == move.to && !x.end && !x.tentative)
      return &x;
  return nullptr;
}

void on_moved(coordinator_pointer self, const rebalance_move& move,
              const completion& moved) {
  auto& st = self->state;
  if (!moved)
    return fail_moves(self, moved.error().message);
  const auto* now = successor_of(st, move);
  if (!now)
    return fail_moves(self, "step '" + move.step + "' of task '" + move.task
                                + "' has ended meanwhile");
  st.rebalance.settle(now->spec.instance,
                      self->clock().now() + limits::task::healthy_for);
  set_timer(self);
}

void make_next_move(coordinator_pointer self) {
  const auto* next = self->state.rebalance.begin_next();
  if (!next)
    return end_moves(self);
  move_instance(
      self, next->instance, next->to, self->state.rebalance.force(),
      [self, move = *next](const completion& x) { on_moved(self, move, x); });
}

cell_rebalanced report_of(coordinator_pointer self, moves_planned plan) {
  return {
      self->state.setup.cell, false,        plan.before,           plan.after,
      plan.lower_bound,       plan.optimal, std::move(plan.moves), ""};
}

/// The moves are known, and begin unless they are only shown.
cell_rebalanced take_up(coordinator_pointer self, const cell_rebalance& request,
                        moves_planned plan) {
  auto& table = self->state.rebalance;
  auto report = report_of(self, std::move(plan));
  if (request.dry_run || report.moves.empty())
    return report;
  if (!table.is_running()) {
    table.begin(std::move(report), request.force);
    self->state.context.publish_event(events::rebalance_begun,
                                      self->state.setup.cell,
                                      {{"moves", table.report().moves.size()},
                                       {"before", table.report().before},
                                       {"after", table.report().after}});
    make_next_move(self);
  }
  return table.report();
}

} // namespace

caf::result<cell_rebalanced> rebalance_cell(coordinator_pointer self,
                                            const cell_rebalance& request) {
  auto& table = self->state.rebalance;
  if (request.stop)
    table.stop();
  if (request.stop || (table.is_running() && !request.dry_run))
    return table.report();
  auto promise = self->make_response_promise<cell_rebalanced>();
  collect_resources_of_cell(
      self, [self, request, promise](cell_resources&& found) mutable {
        self->request(self->state.setup.scheduler, limits::task::search,
                      question_of(self->state, request, std::move(found.nodes)))
            .then(
                [self, request, promise](moves_planned& plan) mutable {
                  promise.deliver(take_up(self, request, std::move(plan)));
                },
                [promise](caf::error& why) mutable {
                  promise.deliver(std::move(why));
                });
      });
  return promise;
}

void watch_moved(coordinator_pointer self, const instance_row& row) {
  const auto& table = self->state.rebalance;
  if (table.settling().empty() || row.spec.instance != table.settling())
    return;
  if (row.state == instance_state::running
      && row.health != instance_health::unhealthy)
    return;
  const auto& why = row.reason.empty() ? row.health_reason : row.reason;
  fail_moves(self, "'" + row.spec.task + "/" + row.spec.step
                       + "' does not run well on its new node: " + why);
}

void settle_due_move(coordinator_pointer self) {
  auto& st = self->state;
  auto& table = st.rebalance;
  if (table.next_due() > self->clock().now())
    return;
  const auto row = st.deployments.find_row(table.settling());
  if (!row || row->state != instance_state::running)
    return fail_moves(self, "the moved instance '" + table.settling()
                                + "' runs no more");
  if (row->health != instance_health::good)
    return fail_moves(self, "the moved instance '" + table.settling() + "' is "
                                + std::string{to_word(row->health)} + ": "
                                + row->health_reason);
  table.complete();
  make_next_move(self);
}

} // namespace roscell
