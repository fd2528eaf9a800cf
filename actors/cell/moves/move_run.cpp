#include "actors/cell/moves/moved_steps.hpp"

#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/core/clocks.hpp"
#include "messages/failure.hpp"

#include <utility>

namespace roscell {

namespace {

using step_list = std::vector<size_t>;
using record_change = task_record (*)(task_record,
                                      const std::vector<replacement>&);

void open_next_wave(coordinator_pointer self, const move_ptr& move);

bool enter(coordinator_pointer self, const move_ptr& move, size_t step,
           move_stage stage) {
  return self->state.moves.enter(move->id, step, stage, self->clock().now());
}

/// Writes a change of the tasks of these steps, then goes on.
///
/// In between a task may be terminated, which takes all of its instances along:
/// that is no problem of the move.
void change_tasks(coordinator_pointer self, const move_ptr& move,
                  const step_list& steps, record_change make,
                  move_stage_handler next) {
  std::map<std::string, std::vector<replacement>> changes;
  for (const auto i : steps)
    changes[move->steps[i].task].push_back(move->steps[i].change);
  move->open = changes.size() + 1;
  for (const auto& [task, moved] : changes) {
    pending_change change;
    change.still = still_of(*move);
    // A task that had ended has its whole time again.
    change.make = [make, moved = moved](task_record record) {
      return with_deadline(make(std::move(record), moved), unix_now_ms());
    };
    change.done = [self, move, next, task = task](const completion& kept) {
      if (!kept && (self->state.tasks.*still_of(*move))(task))
        add_problem(move, kept.error());
      end_part(self, move, next, undo_move);
    };
    change_task(self, task, std::move(change));
  }
  end_part(self, move, next, undo_move);
}

/// Who fell silent meanwhile cannot be told to end the old one, and may run it
/// on for as long as it is away.
std::optional<failure> missed_heartbeats_of(coordinator_pointer self,
                                            const task_move& move,
                                            const moved_step& x) {
  if (move.kind != move_kind::leaving || x.ends_first || !x.was_there
      || !is_away(self->state, x.from))
    return std::nullopt;
  return failure{error_code::unreachable,
                 "node '" + x.from + "' missed its heartbeats while '"
                     + x.change.old_instance + "' was moved"};
}

void end_wave(coordinator_pointer self, const move_ptr& move) {
  complete_steps(self, move,
                 self->state.moves.in_wave(move->id, move_stage::up),
                 open_next_wave);
}

/// The whole wave runs: the new ones take the old ones' places. What has ended
/// by itself meanwhile keeps its own.
void replace_old(coordinator_pointer self, const move_ptr& move) {
  const auto up = self->state.moves.in_wave(move->id, move_stage::up);
  for (const auto i : up)
    if (auto why = missed_heartbeats_of(self, *move, move->steps[i]))
      add_problem(move, *why);
  if (move->problem)
    return undo_move(self, move);
  drop_new(self, move, self->state.moves.in_wave(move->id, move_stage::over));
  const bool beside = !up.empty() && move->kind == move_kind::leaving
                      && !move->steps[up.front()].ends_first;
  change_tasks(self, move, up, beside ? with_replaced : with_restarted,
               end_wave);
}

/// One of the new ones runs, or does not, or is not wanted any more.
void end_step(coordinator_pointer self, const move_ptr& move) {
  if (move->kind == move_kind::lost)
    end_part(self, move, complete_lost, complete_lost);
  else
    end_part(self, move, replace_old, undo_move);
}

void fail_step(coordinator_pointer self, const move_ptr& move, size_t i,
               failure why) {
  const auto& x = move->steps[i];
  why.message = "step '" + x.step.step.id + "' on '" + x.change.place.node
                + "': " + why.message;
  // What was terminated meanwhile need not come up.
  if ((self->state.tasks.*still_of(*move))(x.task))
    add_problem(move, std::move(why));
  else
    enter(self, move, i, move_stage::over);
  end_step(self, move);
}

void leave_out(coordinator_pointer self, const move_ptr& move, size_t i) {
  enter(self, move, i, move_stage::over);
  end_step(self, move);
}

/// In between its node may be lost: the request fails then, and the program may
/// run there until its fence has ended it, which the node failure table knows.
void start_new(coordinator_pointer self, const move_ptr& move, size_t i) {
  auto& st = self->state;
  const auto& x = move->steps[i];
  const auto& spec = x.change.spec;
  const auto& node = x.change.place.node;
  if (!st.deployments.find(spec.instance, node)
      || !(st.tasks.*still_of(*move))(x.task))
    return leave_out(self, move, i);
  if (auto why = missed_heartbeats_of(self, *move, x))
    return fail_step(self, move, i, *why);
  const bool beside = move->kind == move_kind::leaving && !x.ends_first;
  if (auto why =
          why_not_yet(self, {x.task, spec.step, x.change.old_instance, beside}))
    return fail_step(self, move, i, *why);
  const auto* entry = st.registry.find_name(node);
  if (!entry || !entry->agent)
    return fail_step(self, move, i,
                     {error_code::conflict, "the node left meanwhile"});
  if (!note_start(self, spec, node))
    return fail_step(self, move, i,
                     {error_code::conflict, "too many instances are known"});
  enter(self, move, i, move_stage::starting);
  const auto longest = st.moves.deadline_of(move->id, i) - self->clock().now();
  self->request(entry->agent, longest,
                instance_deployment{spec, offer_for(st, spec.skill, node)})
      .then(
          [self, move, i](const instance_deployed&) {
            enter(self, move, i, move_stage::up);
            end_step(self, move);
          },
          [self, move, i](const caf::error& why) {
            fail_step(self, move, i, to_failure(why));
          });
}

/// In between it may end by itself, be terminated, take too long, or its node
/// may be lost.
void end_old(coordinator_pointer self, const move_ptr& move, size_t i) {
  const auto& x = move->steps[i];
  enter(self, move, i, move_stage::ordered);
  ordered_stop stop;
  stop.task = x.task;
  stop.node = x.from;
  stop.order = {x.change.old_instance, "it was ended to run elsewhere", "", 5};
  stop.force = move->force;
  stop.until = self->state.moves.deadline_of(move->id, i);
  stop.has_successor = true;
  stop.asked = [self, move, i] {
    move->steps[i].was_asked = true;
    enter(self, move, i, move_stage::ending);
  };
  stop.done = [self, move, i](stop_outcome how, const completion& stopped) {
    if (how == stop_outcome::ended)
      start_new(self, move, i);
    else if (how == stop_outcome::had_ended)
      leave_out(self, move, i);
    else
      fail_step(self, move, i, stopped.error());
  };
  stop_by_order(self, stop);
}

/// Whether the old one has ended, or nobody wants it any more.
bool is_over(const cell_coordinator_state& st, const task_move& move,
             const moved_step& x) {
  const auto* old = st.deployments.find(x.change.old_instance, x.from);
  return !(st.tasks.*still_of(move))(x.task)
         || (move.kind == move_kind::leaving
             && (!old || old->end || has_ordered_end(st, *old)));
}

void begin_step(coordinator_pointer self, const move_ptr& move, size_t i) {
  const auto& x = move->steps[i];
  // One that does not come up is tried elsewhere: its task goes on.
  if (move->kind == move_kind::lost)
    self->state.deployments.ignore_end(x.change.spec.instance);
  else if (is_over(self->state, *move, x))
    return leave_out(self, move, i);
  if (x.ends_first)
    end_old(self, move, i);
  else
    start_new(self, move, i);
}

void open_next_wave(coordinator_pointer self, const move_ptr& move) {
  const auto wave = self->state.moves.open_wave(move->id);
  if (wave.empty())
    return end_move(self, move);
  move->open = wave.size();
  for (const auto i : wave)
    begin_step(self, move, i);
}

/// The room is held in the tables from here on, so the placement lock is
/// released.
void open_first_wave(coordinator_pointer self, const move_ptr& move) {
  release_placement_lock(self, std::exchange(move->placement_lock, 0));
  open_next_wave(self, move);
}

/// Whether all of them are still lost. From here on what returns of them is to
/// end, whether the store has kept that they have moved or not.
bool give_up(coordinator_pointer self, const task_move& move) {
  auto& failures = self->state.failures;
  for (const auto& x : move.steps)
    if (!failures.find_abandoned(x.change.old_instance))
      return false;
  for (const auto& x : move.steps)
    failures.give_up(x.change.old_instance);
  return true;
}

std::vector<moving_step> in_table(const task_move& move) {
  std::vector<moving_step> result;
  for (const auto& x : move.steps) {
    moving_step step;
    step.task = x.task;
    step.step = x.change.spec.step;
    step.node = x.from;
    step.ends_first = x.ends_first;
    step.together = x.step.together;
    result.push_back(std::move(step));
  }
  return result;
}

/// All have room. The new instances are written down beside the old ones, or
/// instead of them where these are lost: then they are given up by that.
void hold_steps(coordinator_pointer self, const move_ptr& move) {
  auto& moves = self->state.moves;
  move->id = moves.begin(in_table(*move), move->kind == move_kind::leaving);
  for (size_t i = 0; i < move->steps.size(); ++i)
    move->steps[i].ends_first = moves.ends_first(move->id, i);
  const auto all = moves.at(move->id, move_stage::placed);
  if (move->kind != move_kind::lost)
    return change_tasks(self, move, all, with_tentative, open_first_wave);
  if (give_up(self, *move))
    return change_tasks(self, move, all, with_restarted, open_first_wave);
  add_problem(move, {error_code::conflict, "a node came back meanwhile"});
  undo_move(self, move);
}

} // namespace

void run_move(coordinator_pointer self, const move_ptr& move) {
  place_move(self, move, hold_steps);
}

} // namespace roscell
