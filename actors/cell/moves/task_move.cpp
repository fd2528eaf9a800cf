#include "actors/cell/moves/task_move.hpp"

#include "actors/cell/moves/move_stages.hpp"
#include "actors/cell/tasks/task_turns.hpp"
#include "messages/failure.hpp"

#include <memory>
#include <optional>

namespace roscell {

namespace {

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
    if (x.node == node && !x.end) {
      if (auto why = add_moved_step(self, move, *request, x, false))
        return why;
      // Two of them would move the same robot.
      if (x.spec.life.safe_state) {
        move.kind = move_kind::restarted;
        move.ends_first = true;
      }
    }
  return std::nullopt;
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

} // namespace roscell
