#include "actors/cell/moves/task_move.hpp"

#include "actors/cell/moves/move_end.hpp"
#include "actors/cell/moves/move_run.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "messages/failure.hpp"

#include <memory>
#include <optional>

namespace roscell {

namespace {

/// Who has asked for it did not know that the node would fall silent before
/// there was a turn.
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

} // namespace roscell
