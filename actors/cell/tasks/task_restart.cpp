#include "actors/cell/tasks/cell_tasks.hpp"

#include "actors/cell/moves/moved_steps.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_views.hpp"
#include "actors/cell/updates/update_guard.hpp"
#include "actors/core/answer_limits.hpp"
#include "messages/failure.hpp"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

namespace roscell {

namespace {

using instance_list = std::vector<std::string>;

bool has_failed(const deployment& x) {
  return x.end
         && (x.end->state != instance_state::stopped || x.end->exit_code != 0);
}

/// Its node has gone from the cell for good.
bool is_nowhere(const cell_coordinator_state& st, const deployment& x) {
  return !x.end && !x.tentative && !st.registry.find_name(x.node);
}

bool is_to_be_healed(const cell_coordinator_state& st, const deployment& x) {
  return has_failed(x) || is_nowhere(st, x);
}

bool has(const instance_list& list, const std::string& instance) {
  return std::find(list.begin(), list.end(), instance) != list.end();
}

/// Starts these instances anew. Those in `stay` do so on their nodes.
void start_again(coordinator_pointer self, const move_ptr& move,
                 const std::string& task, const instance_list& wanted,
                 const instance_list& stay) {
  const auto& st = self->state;
  if (auto why = why_busy(st, task))
    return fail_move(self, move, *why);
  const auto request = request_of(*st.tasks.find(task));
  if (!request)
    return fail_move(self, move, without_request(task));
  for (const auto& x : st.deployments.of_task(task))
    if (has(wanted, x.spec.instance))
      if (auto why = add_moved_step(self, *move, *request, x,
                                    has(stay, x.spec.instance) ? x.node : ""))
        return fail_move(self, move, *why);
  run_move(self, move);
}

void take_placement_lock_to_start(coordinator_pointer self,
                                  const std::string& task,
                                  const instance_list& wanted,
                                  const instance_list& stay,
                                  const completion_handler& done) {
  auto move = std::make_shared<task_move>();
  move->what = "the instances of task '" + task + "'";
  move->kind = move_kind::restarted;
  move->done = done;
  take_placement_lock(
      self, caf::actor_addr{},
      [self, move, task, wanted, stay](uint64_t placement_lock) {
        move->placement_lock = placement_lock;
        start_again(self, move, task, wanted, stay);
      });
}

/// Ends these instances of a task on their nodes.
/// @param next called once, when all have ended, or with the first problem.
///
/// Meanwhile each may end by itself, and is started again all the same.
void end_instances(coordinator_pointer self, const task_restart& request,
                   const instance_list& instances,
                   const completion_handler& next) {
  struct tally {
    size_t open = 1;
    std::optional<failure> problem;
  };
  auto all = std::make_shared<tally>();
  const auto finish = [all, next](const completion& stopped) {
    if (!stopped && !all->problem)
      all->problem = stopped.error();
    if (--all->open == 0)
      next(all->problem);
  };
  for (const auto& instance : instances) {
    const auto* x = self->state.deployments.find(instance);
    if (!x)
      continue;
    ++all->open;
    ordered_stop stop;
    stop.task = request.task;
    stop.node = x->node;
    stop.order = {instance, "it was ended to be started again", "", 5};
    stop.force = request.force;
    stop.until = self->clock().now() + limits::task::eviction;
    stop.has_successor = true;
    stop.done = [finish](stop_outcome, const completion& ended) {
      finish(ended);
    };
    stop_by_order(self, stop);
  }
  finish({});
}

/// What a restart is about; or why there can be none.
struct restart_plan {
  instance_list wanted;
  instance_list running; ///< Those of them that run.
  std::optional<failure> problem;
};

restart_plan plan_restart(const cell_coordinator_state& st,
                          const task_restart& request) {
  restart_plan result;
  result.problem = why_updating(st, request.task);
  if (!result.problem)
    result.problem = why_busy(st, request.task);
  for (const auto& x : st.deployments.of_task(request.task)) {
    if (!request.instance.empty() && x.spec.instance != request.instance)
      continue;
    result.wanted.push_back(x.spec.instance);
    if (x.end)
      continue;
    result.running.push_back(x.spec.instance);
    if (!result.problem)
      result.problem = why_not_ordered(st, x.spec.instance);
    const auto* node = st.registry.find_name(x.node);
    if (!result.problem && (!node || !node->agent))
      result.problem =
          failure{error_code::conflict,
                  "node '" + x.node + "' is away, so instance '"
                      + x.spec.instance + "' cannot be ended",
                  "/instance", "wait for the node, or terminate the task"};
  }
  return result;
}

/// The instances of a task that were not there before.
std::vector<placed_instance> new_instances(const cell_coordinator_state& st,
                                           const task_restart& request,
                                           const instance_list& before) {
  std::vector<placed_instance> result;
  for (const auto& x : st.deployments.of_task(request.task))
    if (!has(before, x.spec.instance))
      result.push_back({x.spec.step, x.spec.instance, x.node});
  return result;
}

instance_list all_instances(const cell_coordinator_state& st,
                            const std::string& task) {
  instance_list result;
  for (const auto& x : st.deployments.of_task(task))
    result.push_back(x.spec.instance);
  return result;
}

} // namespace

std::optional<failure> why_busy(const cell_coordinator_state& st,
                                const std::string& task) {
  for (const auto& [instance, change] : st.pending.parameter_changes)
    if (change.task == task)
      return failure{error_code::conflict,
                     "parameters of instance '" + instance
                         + "' are being changed",
                     "/task", "send it again in a while"};
  return why_unsettled(st, task);
}

std::optional<failure> why_unsettled(const cell_coordinator_state& st,
                                     const std::string& task) {
  const auto* entry = st.tasks.find(task);
  if (!entry || entry->ending || entry->state == task_state::deploying)
    return failure{error_code::conflict,
                   "task '" + task + "' is being deployed or terminated",
                   "/task", "send it again in a while"};
  if (auto why = why_too_late(st, task))
    return why;
  const auto& placed = st.deployments.of_task(task);
  if (std::any_of(placed.begin(), placed.end(),
                  [](const auto& x) { return x.tentative; }))
    return failure{error_code::conflict,
                   "instances of task '" + task
                       + "' are being moved or started again",
                   "/task", "send it again when they run"};
  return std::nullopt;
}

std::vector<std::string> steps_to_heal(const cell_coordinator_state& st,
                                       const std::string& task) {
  std::vector<std::string> result;
  for (const auto& x : st.deployments.of_task(task))
    if (is_to_be_healed(st, x))
      result.push_back(x.spec.step);
  return result;
}

void heal_task(coordinator_pointer self, const std::string& task,
               const completion_handler& done) {
  const auto& st = self->state;
  if (const auto why = why_updating(st, task))
    return done(*why);
  instance_list wanted;
  std::string gone;
  for (const auto& x : st.deployments.of_task(task)) {
    if (!is_to_be_healed(st, x))
      continue;
    wanted.push_back(x.spec.instance);
    if (is_nowhere(st, x))
      gone = "step '" + x.spec.step + "' was on node '" + x.node
             + "', which the cell does not have any more, and has no other "
               "place: ";
  }
  take_placement_lock_to_start(self, task, wanted, {},
                               [gone, done](const completion& started) {
                                 if (started || gone.empty())
                                   return done(started);
                                 auto problem = started.error();
                                 problem.message = gone + problem.message;
                                 done(problem);
                               });
}

void start_ended(coordinator_pointer self, const std::string& task,
                 const std::vector<std::string>& instances,
                 const completion_handler& done) {
  if (const auto why = why_updating(self->state, task))
    return done(*why);
  take_placement_lock_to_start(self, task, instances, {}, done);
}

void start_where_they_were(coordinator_pointer self, const std::string& task,
                           const std::vector<std::string>& instances,
                           const completion_handler& done) {
  take_placement_lock_to_start(
      self, task, instances, instances,
      [self, task, instances, done](const completion& started) {
        if (started
            || started.error().code != error_code::no_feasible_allocation)
          return done(started);
        take_placement_lock_to_start(self, task, instances, {}, done);
      });
}

caf::result<task_restarted> restart_task(coordinator_pointer self,
                                         const task_restart& request) {
  const auto& st = self->state;
  if (!st.tasks.find(request.task))
    return unknown_thing("task", request.task);
  const auto plan = plan_restart(st, request);
  if (plan.problem)
    return to_error(*plan.problem);
  if (plan.wanted.empty())
    return unknown_thing("instance", request.instance);
  auto promise = self->make_response_promise<task_restarted>();
  const auto before = all_instances(st, request.task);
  auto finish = [self, request, before, plan,
                 promise](const completion& started) mutable {
    for (const auto& instance : plan.running)
      end_as_ordered(self, request.task, instance,
                     "it was ended to be started again: "
                         + (started ? "" : started.error().message));
    record_ends(self, request.task);
    if (!started)
      promise.deliver(to_error(started.error()));
    else
      promise.deliver(task_restarted{
          request.task, new_instances(self->state, request, before)});
  };
  end_instances(self, request, plan.running,
                [self, request, plan, finish](const completion& ended) mutable {
                  if (!ended)
                    finish(ended);
                  else
                    take_placement_lock_to_start(
                        self, request.task, plan.wanted, plan.running, finish);
                });
  return promise;
}

} // namespace roscell
