#include "actors/cell/moves/move_stages.hpp"

#include "actors/cell/moves/lost_remains.hpp"
#include "actors/cell/moves/lost_steps.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/cell/tasks/task_turns.hpp"
#include "actors/house/limits.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

/// Writes a change of each task, then goes on.
void change_tasks(coordinator_pointer self, const move_ptr& move,
                  task_record (*make)(task_record,
                                      const std::vector<replacement>&),
                  move_stage next) {
  const auto changes = by_task(*move);
  move->open = changes.size();
  for (const auto& [task, moved] : changes) {
    pending_change change;
    change.still = still_of(*move);
    change.make = [make, moved = moved](task_record record) {
      return make(std::move(record), moved);
    };
    change.done = [self, move, next, task = task](const failure* why) {
      // A task that was terminated meanwhile takes all of its instances along.
      if (why && (self->state.tasks.*still_of(*move))(task))
        add_problem(move, *why);
      end_part(self, move, next, undo_move);
    };
    change_task(self, task, std::move(change));
  }
}

/// Who fell silent meanwhile cannot be told to end the old one, and may run it
/// on for as long as it is away.
void look_for_silence(coordinator_pointer self, const move_ptr& move) {
  if (move->kind != move_kind::leaving)
    return;
  for (const auto& x : move->steps)
    if (x.was_there && is_away(self->state, x.from))
      add_problem(move, {error_code::unreachable,
                         "node '" + x.from + "' fell silent while '"
                             + x.change.old_instance + "' was moved"});
}

void replace_old(coordinator_pointer self, const move_ptr& move) {
  look_for_silence(self, move);
  if (move->problem)
    return undo_move(self, move);
  change_tasks(self, move,
               move->kind == move_kind::leaving ? with_replaced
                                                : with_restarted,
               complete_move);
}

/// One of the new ones runs, or does not.
void end_deployment(coordinator_pointer self, const move_ptr& move) {
  if (move->kind == move_kind::lost)
    end_part(self, move, complete_lost, complete_lost);
  else
    end_part(self, move, replace_old, undo_move);
}

/// Nobody can end the old one, but its fence does.
failure still_fenced(const moved_step& x, std::chrono::milliseconds left) {
  const auto s = std::chrono::ceil<std::chrono::seconds>(left).count();
  return {error_code::conflict,
          "node '" + x.from + "' is away and may still run '"
              + x.change.old_instance + "'",
          "/instances",
          "it has ended there in " + std::to_string(s)
              + " s, and moves by itself then; or say \"terminate\""};
}

/// Why the old one may run where nobody can end it.
std::optional<failure> may_run_there(coordinator_pointer self,
                                     const task_move& move,
                                     const moved_step& x) {
  const auto& instance = x.change.old_instance;
  if (move.kind == move_kind::lost)
    return std::nullopt;
  const auto* lost = self->state.losses.find(instance);
  if (lost && lost->is_alone)
    return may_start_alone(instance, x.from);
  if (const auto left = may_run_on(self, instance))
    return still_fenced(x, *left);
  return std::nullopt;
}

void deploy_step(coordinator_pointer self, const move_ptr& move,
                 const moved_step& x) {
  const auto& node = x.change.place.node;
  auto end_with = [self, move, node, task = x.task,
                   step = x.step.step.id](failure why) {
    why.message = "step '" + step + "' on '" + node + "': " + why.message;
    // What was terminated meanwhile need not come up.
    if ((self->state.tasks.*still_of(*move))(task))
      add_problem(move, std::move(why));
    end_deployment(self, move);
  };
  // Nor is it started.
  if (!self->state.deployments.find(x.change.spec.instance, node)
      || !(self->state.tasks.*still_of(*move))(x.task))
    return end_deployment(self, move);
  if (auto why = may_run_there(self, *move, x))
    return end_with(*why);
  const auto* entry = self->state.registry.find_name(node);
  if (!entry || !entry->agent)
    return end_with({error_code::conflict, "the node left meanwhile"});
  self->request(entry->agent, limits::task::deployment,
                instance_deployment{x.change.spec})
      .then(
          [self, move,
           instance = x.change.spec.instance](const instance_deployed&) {
            for (auto& step : move->steps)
              step.is_up = step.is_up || step.change.spec.instance == instance;
            end_deployment(self, move);
          },
          [end_with](const caf::error& why) { end_with(to_failure(why)); });
}

void deploy_after_end(coordinator_pointer self, const move_ptr& move,
                      const moved_step& x) {
  if (is_surely_gone(self->state, x.from, x.change.old_instance))
    return deploy_step(self, move, x);
  add_problem(move, {error_code::conflict,
                     "nobody knows whether '" + x.change.old_instance
                         + "' on node '" + x.from + "' has ended"});
  end_deployment(self, move);
}

/// The room is held in the books from here on, so the turn is over.
void deploy_steps(coordinator_pointer self, const move_ptr& move) {
  end_turn(self, std::exchange(move->turn, 0));
  move->open = move->steps.size();
  const auto steps = move->steps;
  for (const auto& x : steps) {
    // One that does not come up is tried elsewhere: its task goes on.
    if (move->kind == move_kind::lost)
      self->state.deployments.ignore_end(x.change.spec.instance);
    if (!move->ends_first) {
      deploy_step(self, move, x);
      continue;
    }
    self->state.deployments.ignore_end(x.change.old_instance);
    remove_instance(
        self, {x.from, x.task, x.change.old_instance},
        [self, move, x] { deploy_after_end(self, move, x); }, move->force);
  }
}

/// Whether all of them are still lost. From here on what returns of them is to
/// end, whether the store has kept that they have moved or not.
bool give_up(coordinator_pointer self, const task_move& move) {
  auto& losses = self->state.losses;
  for (const auto& x : move.steps)
    if (!losses.find(x.change.old_instance))
      return false;
  for (const auto& x : move.steps)
    losses.give_up(x.change.old_instance);
  return true;
}

} // namespace

std::map<std::string, std::vector<replacement>> by_task(const task_move& move) {
  std::map<std::string, std::vector<replacement>> result;
  for (const auto& x : move.steps)
    result[x.task].push_back(x.change);
  return result;
}

task_question still_of(const task_move& move) {
  return move.kind == move_kind::restarted ? &task_book::is_kept
                                           : &task_book::is_running;
}

void fail_move(coordinator_pointer self, const move_ptr& move,
               const failure& why) {
  end_turn(self, move->turn);
  move->done(&why);
}

void end_part(coordinator_pointer self, const move_ptr& move, move_stage next,
              move_stage otherwise) {
  if (--move->open > 0)
    return;
  (move->problem ? otherwise : next)(self, move);
}

void add_problem(const move_ptr& move, failure why) {
  if (!move->problem)
    move->problem = std::move(why);
}

void hold_steps(coordinator_pointer self, const move_ptr& move) {
  if (move->kind != move_kind::lost)
    return change_tasks(self, move, with_tentative, deploy_steps);
  if (give_up(self, *move))
    return change_tasks(self, move, with_restarted, deploy_steps);
  add_problem(move, {error_code::conflict, "a node came back meanwhile"});
  undo_move(self, move);
}

} // namespace roscell
