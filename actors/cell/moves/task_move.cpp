#include "actors/cell/moves/task_move.hpp"

#include "actors/cell/moves/move_stages.hpp"
#include "actors/cell/tasks/task_turns.hpp"
#include "messages/failure.hpp"

#include <memory>
#include <optional>

namespace roscell {

namespace {

/// Adds a step that is to run elsewhere, or on that node.
std::optional<failure> add_step(coordinator_pointer self, task_move& move,
                                const task_request& request,
                                const deployment& x, const std::string& to) {
  // Two of them would move the same robot.
  if (x.spec.life.safe_state) {
    move.kind = move_kind::restarted;
    move.ends_first = true;
  }
  return add_moved_step(self, move, request, x, to);
}

/// The steps of a task that run on the node, resolved anew: the node's own
/// version of a skill may be leaving with it.
std::optional<failure> add_steps(coordinator_pointer self, task_move& move,
                                 const std::string& task,
                                 const std::string& node) {
  const auto& st = self->state;
  const auto request = request_of(*st.tasks.find(task));
  if (!request)
    return failure{error_code::internal,
                   "task '" + task + "' has no request any more"};
  for (const auto& x : st.deployments.of_task(task))
    if (x.node == node && !x.end)
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
    return failure{error_code::internal,
                   "task '" + x->spec.task + "' has no request any more"};
  return add_step(self, move, *request, *x, to);
}

} // namespace

void move_tasks(coordinator_pointer self, const std::string& node,
                const std::vector<std::string>& tasks,
                const std::function<void(const failure*)>& done) {
  auto move = std::make_shared<task_move>();
  move->what = "the instances of node '" + node + "'";
  move->done = done;
  take_turn(self, caf::actor_addr{}, [self, move, node, tasks](uint64_t turn) {
    move->turn = turn;
    for (const auto& task : tasks)
      if (self->state.tasks.is_running(task))
        if (auto why = add_steps(self, *move, task, node))
          return fail_move(self, move, *why);
    place_move(self, move);
  });
}

void move_instance(coordinator_pointer self, const std::string& instance,
                   const std::string& to, bool force,
                   const std::function<void(const failure*)>& done) {
  auto move = std::make_shared<task_move>();
  move->what = "instance '" + instance + "'";
  move->force = force;
  move->done = done;
  take_turn(self, caf::actor_addr{}, [self, move, instance, to](uint64_t turn) {
    move->turn = turn;
    if (auto why = add_instance(self, *move, instance, to))
      return fail_move(self, move, *why);
    place_move(self, move);
  });
}

} // namespace roscell
