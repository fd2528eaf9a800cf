#include "actors/cell/moves/move_stages.hpp"

#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/task_story.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_endings.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/house/limits.hpp"

#include <utility>

/// How a move ends.
namespace roscell {

namespace {

void tell_moved(coordinator_pointer self, const moved_step& x) {
  const auto* fact =
      x.from != x.change.place.node ? "instance_moved" : "instance_restarted";
  tell_of_task(self, fact, x.task, x.change.spec.instance,
               {{"task", x.task},
                {"from", x.from},
                {"to", x.change.place.node},
                {"replaces", x.change.old_instance},
                {"step", x.change.spec.step}});
}

void forget_new(coordinator_pointer self, const move_ptr& move) {
  for (const auto& [task, changes] : by_task(*move)) {
    std::vector<std::string> added;
    for (const auto& x : changes)
      added.push_back(x.spec.instance);
    if (!self->state.deployments.find(added.front()))
      continue;
    pending_change change;
    change.still = &task_book::is_kept;
    change.insistent = true;
    change.make = [added](task_record record) {
      return without(std::move(record), added);
    };
    change.done = [self, task = task](const failure*) {
      record_ends(self, task);
    };
    change_task(self, task, std::move(change));
  }
}

/// It has come to nothing: it is placed once more, elsewhere if need be.
void lose_again(coordinator_pointer self, const moved_step& x) {
  const auto& node = x.change.place.node;
  const auto* entry = self->state.registry.find_name(node);
  const auto uuid = entry ? entry->row.identity.uuid : std::string{};
  self->state.losses.lose(
      {x.task, x.change.spec.instance, node, uuid, self->clock().now()},
      limits::retry::longest);
  set_timer(self);
}

/// One that has ended already, to make room for the other, has failed by that.
void heed_old(coordinator_pointer self, const task_move& move,
              const moved_step& x) {
  const auto& old = x.change.old_instance;
  if (move.ends_first && is_surely_gone(self->state, x.from, old))
    record_forced_end(self, x.task, old,
                      "it was ended to run elsewhere: " + move.problem->message,
                      [](const failure*) {});
  else
    self->state.deployments.heed_end(old);
}

} // namespace

void complete_move(coordinator_pointer self, const move_ptr& move) {
  move->open = move->steps.size();
  const auto steps = move->steps;
  for (const auto& x : steps) {
    const auto& added = x.change.spec.instance;
    const auto* placed = self->state.deployments.find(added);
    const bool moved = placed && !placed->tentative;
    if (moved)
      tell_moved(self, x);
    record_ends(self, x.task);
    remove_instance(self,
                    moved
                        ? overdue_removal{x.from, x.task, x.change.old_instance}
                        : overdue_removal{x.change.place.node, x.task, added},
                    [move] {
                      if (--move->open == 0)
                        move->done(nullptr);
                    });
  }
}

void complete_lost(coordinator_pointer self, const move_ptr& move) {
  for (const auto& x : move->steps) {
    self->state.losses.forget(x.change.old_instance);
    if (x.is_up) {
      self->state.deployments.heed_end(x.change.spec.instance);
      tell_moved(self, x);
    } else {
      lose_again(self, x);
    }
  }
  for (const auto& x : move->steps)
    record_ends(self, x.task);
  move->done(move->problem ? &*move->problem : nullptr);
}

void undo_move(coordinator_pointer self, const move_ptr& move) {
  for (const auto& x : move->steps)
    remove_instance(self, {x.change.place.node, x.task, x.change.spec.instance},
                    [] {});
  // A task's state is that of the instances it still has.
  forget_new(self, move);
  for (const auto& x : move->steps)
    heed_old(self, *move, x);
  fail_move(self, move, *move->problem);
}

} // namespace roscell
