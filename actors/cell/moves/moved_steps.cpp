#include "actors/cell/moves/moved_steps.hpp"

#include "actors/cell/state/build_offers.hpp"
#include "actors/cell/state/coordinator_store.hpp"
#include "actors/cell/state/coordinator_timer.hpp"
#include "actors/cell/state/may_start.hpp"
#include "actors/cell/tasks/placement_locks.hpp"
#include "actors/cell/tasks/step_ends.hpp"
#include "actors/cell/tasks/task_changes.hpp"
#include "actors/cell/tasks/task_removals.hpp"
#include "actors/core/limits.hpp"
#include "actors/placement/reading/wiring.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "messages/event_kinds.hpp"
#include "schemas/document.hpp"

#include <algorithm>
#include <map>
#include <utility>
#include <variant>

namespace roscell {

namespace {

std::vector<std::string> only(const std::vector<std::string>& nodes,
                              const std::string& wanted) {
  const bool has = std::find(nodes.begin(), nodes.end(), wanted) != nodes.end();
  return has ? std::vector<std::string>{wanted} : std::vector<std::string>{};
}

/// The step of an instance as it is written, with the ends that it has.
std::optional<task_step> step_of(const task_request& request,
                                 const deployment& old) {
  const auto found =
      std::find_if(request.pipeline.begin(), request.pipeline.end(),
                   [&](const auto& x) { return x.id == old.spec.step; });
  if (found == request.pipeline.end())
    return std::nullopt;
  auto result = *found;
  // Short forms stay what they were read as.
  result.input = old.spec.input;
  result.output = old.spec.output;
  return result;
}

std::variant<std::vector<resolved_step>, failure>
resolve(const cell_coordinator_state& st, const task_step& step) {
  return resolve_steps({step}, skills_within_reach(st));
}

} // namespace

task_question still_of(const task_move& move) {
  return move.kind == move_kind::restarted ? &task_table::is_kept
                                           : &task_table::is_running;
}

void add_problem(const move_ptr& move, failure why) {
  if (!move->problem)
    move->problem = std::move(why);
}

void end_part(coordinator_pointer self, const move_ptr& move,
              move_stage_handler next, move_stage_handler otherwise) {
  if (--move->open > 0)
    return;
  (move->problem ? otherwise : next)(self, move);
}

std::optional<task_request> request_of(const task_entry& entry) {
  const auto document = json::parse(entry.request, nullptr, false);
  if (document.is_discarded())
    return std::nullopt;
  auto decoded = decode<task_request>(document);
  if (auto* request = std::get_if<task_request>(&decoded))
    return std::move(*request);
  return std::nullopt;
}

failure without_request(const std::string& task) {
  return {error_code::internal,
          "the record of task '" + task + "' is damaged: it has no request",
          "/task", "terminate the task, and run it again"};
}

std::optional<failure> why_too_late(const cell_coordinator_state& st,
                                    const std::string& task) {
  if (!st.deadlines.is_late(task))
    return std::nullopt;
  return failure{error_code::conflict,
                 "the timeout_s of task '" + task
                     + "' is over, and it is being ended",
                 "/task", "send it again when it has ended"};
}

std::optional<failure> add_moved_step(coordinator_pointer self, task_move& move,
                                      const task_request& request,
                                      const deployment& old,
                                      const std::string& only_on) {
  const auto written = step_of(request, old);
  if (!written)
    return std::nullopt;
  if (auto why = why_too_late(self->state, request.task))
    return why;
  auto resolved = resolve(self->state, *written);
  if (auto* why = std::get_if<failure>(&resolved))
    return *why;
  moved_step moved;
  moved.task = request.task;
  moved.from = old.node;
  const auto* node = self->state.registry.find_name(old.node);
  moved.was_there = node && node->agent;
  moved.change.old_instance = old.spec.instance;
  moved.step = std::move(std::get<0>(resolved).front());
  if (!only_on.empty())
    for (auto& build : moved.step.builds)
      build.nodes = only(build.nodes, only_on);
  move.steps.push_back(std::move(moved));
  return std::nullopt;
}

std::optional<resolved_step> resolve_anew(const cell_coordinator_state& st,
                                          const task_request& request,
                                          const deployment& old) {
  const auto written = step_of(request, old);
  if (!written)
    return std::nullopt;
  auto resolved = resolve(st, *written);
  if (auto* steps = std::get_if<std::vector<resolved_step>>(&resolved))
    return std::move(steps->front());
  return std::nullopt;
}

void bind_together(const std::string& task, std::vector<resolved_step>& steps) {
  std::vector<written_step> written;
  written.reserve(steps.size());
  for (const auto& x : steps)
    written.push_back(as_written(x.step));
  const auto together = find_wiring(task, written, {}).together;
  for (size_t i = 0; i < steps.size(); ++i)
    steps[i].together = together[i];
}

void keep_together(task_move& move) {
  std::map<std::string, std::vector<size_t>> by_task;
  for (size_t i = 0; i < move.steps.size(); ++i)
    by_task[move.steps[i].task].push_back(i);
  uint64_t groups = 0;
  for (const auto& [task, members] : by_task) {
    std::vector<resolved_step> of_task;
    for (const auto i : members)
      of_task.push_back(move.steps[i].step);
    bind_together(task, of_task);
    for (size_t k = 0; k < members.size(); ++k) {
      const auto number = of_task[k].together;
      move.steps[members[k]].step.together = number == 0 ? 0 : groups + number;
    }
    groups += members.size();
  }
}

namespace {

void publish_moved(coordinator_pointer self, const moved_step& x) {
  const auto& event = x.from != x.change.place.node
                          ? events::instance_moved
                          : events::instance_restarted;
  publish_task_event(self, event, x.task, x.change.spec.instance,
                     {{"task", x.task},
                      {"from", x.from},
                      {"to", x.change.place.node},
                      {"replaces", x.change.old_instance},
                      {"step", x.change.spec.step}});
}

/// A task's state is that of the instances it still has.
void forget_new(coordinator_pointer self, const std::string& task,
                const std::vector<std::string>& added) {
  if (!self->state.deployments.find(added.front()))
    return;
  pending_change change;
  change.still = &task_table::is_kept;
  change.insistent = true;
  change.make = [added](task_record record) {
    return without(std::move(record), added);
  };
  change.done = [self, task](const completion&) { record_ends(self, task); };
  change_task(self, task, std::move(change));
}

/// It has come to nothing: it is placed once more, elsewhere if need be and if
/// it may, once it has surely ended there.
/// @param before what it was to take the place of.
void abandon_again(coordinator_pointer self, const moved_step& x,
                   const abandoned_step& before) {
  const auto& node = x.change.place.node;
  const auto* entry = self->state.registry.find_name(node);
  abandoned_step again;
  again.task = x.task;
  again.step = x.change.spec.step;
  again.instance = x.change.spec.instance;
  again.node = node;
  again.uuid = entry ? entry->row.identity.uuid : std::string{};
  again.stays = before.stays;
  again.pause = before.pause;
  again.due = self->clock().now() + again.pause.next();
  self->state.failures.abandon(std::move(again));
  set_timer(self);
}

/// The old instance of a step that does not move.
void keep_old(coordinator_pointer self, const task_move& move,
              const moved_step& x) {
  const auto& old = x.change.old_instance;
  if (!x.was_asked)
    self->state.deployments.heed_end(old);
  else
    end_as_ordered(self, x.task, old,
                   "it was ended to run elsewhere: " + move.problem->message);
}

} // namespace

void end_move(coordinator_pointer self, const move_ptr& move) {
  release_placement_lock(self, std::exchange(move->placement_lock, 0));
  self->state.moves.end(move->id);
  move->done(move->problem);
}

void fail_move(coordinator_pointer self, const move_ptr& move,
               const failure& why) {
  add_problem(move, why);
  end_move(self, move);
}

void complete_steps(coordinator_pointer self, const move_ptr& move,
                    const std::vector<size_t>& steps, move_stage_handler next) {
  auto& st = self->state;
  move->open = steps.size() + 1;
  for (const auto i : steps) {
    const auto& x = move->steps[i];
    const auto& added = x.change.spec.instance;
    const auto* placed = st.deployments.find(added);
    const bool moved = placed && !placed->tentative;
    st.moves.enter(move->id, i, moved ? move_stage::moved : move_stage::over,
                   self->clock().now());
    if (moved)
      publish_moved(self, x);
    record_ends(self, x.task);
    remove_instance(self,
                    moved
                        ? overdue_removal{x.from, x.task, x.change.old_instance}
                        : overdue_removal{x.change.place.node, x.task, added},
                    [self, move, next] { end_part(self, move, next, next); });
  }
  end_part(self, move, next, next);
}

void drop_new(coordinator_pointer self, const move_ptr& move,
              const std::vector<size_t>& steps) {
  std::map<std::string, std::vector<std::string>> added;
  for (const auto i : steps) {
    const auto& x = move->steps[i];
    const auto& instance = x.change.spec.instance;
    added[x.task].push_back(instance);
    remove_instance(self, {x.change.place.node, x.task, instance}, [] {});
  }
  for (const auto& [task, instances] : added)
    forget_new(self, task, instances);
}

void undo_move(coordinator_pointer self, const move_ptr& move) {
  auto& st = self->state;
  std::vector<size_t> left;
  for (size_t i = 0; i < move->steps.size(); ++i)
    // Before it has room it is in no table.
    if (move->id == 0
        || st.moves.enter(move->id, i, move_stage::undone, self->clock().now()))
      left.push_back(i);
  drop_new(self, move, left);
  for (const auto i : left)
    keep_old(self, *move, move->steps[i]);
  end_move(self, move);
}

void complete_lost(coordinator_pointer self, const move_ptr& move) {
  auto& st = self->state;
  for (size_t i = 0; i < move->steps.size(); ++i) {
    const auto& x = move->steps[i];
    const auto* lost = st.failures.find_abandoned(x.change.old_instance);
    const auto before = lost ? *lost : abandoned_step{};
    st.failures.forget(x.change.old_instance);
    if (st.moves.is_at(move->id, i, move_stage::up)) {
      st.deployments.heed_end(x.change.spec.instance);
      publish_moved(self, x);
    } else if (st.tasks.is_running(x.task)
               && st.deployments.find(x.change.spec.instance)) {
      abandon_again(self, x, before);
    }
  }
  for (const auto& x : move->steps)
    record_ends(self, x.task);
  end_move(self, move);
}

} // namespace roscell
