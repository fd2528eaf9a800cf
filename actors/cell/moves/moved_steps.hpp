#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/failure.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// INTERNAL to moves and restarts: one move, from its steps over their
/// placement to its end. `task_move` carries what its messages need, shared by
/// their continuations; the stage that each step is in stands in the move
/// table. `run_move` is where it begins, and its `done` is called once,
/// whatever happens.
namespace roscell {

/// One instance that takes another one's place.
struct moved_step {
  std::string task;
  resolved_step step;
  replacement change;
  std::string from;        ///< Node of the old one.
  bool was_there = false;  ///< That node was no lost one when this began.
  bool ends_first = false; ///< The old one ends before the new one starts.
  bool was_asked = false;  ///< The old one was told to end.
};

/// What the replaced instances do.
enum class move_kind {
  leaving,   ///< They run until the new ones do, or end first.
  restarted, ///< They have ended.
  lost,      ///< Nobody knows, and they end when they come back.
};

/// What the messages of one move carry along. How far it is stands in the move
/// table.
struct task_move {
  std::string what; ///< Whose instances they are, for errors.
  move_kind kind = move_kind::leaving;
  uint64_t placement_lock = 0;
  uint64_t id = 0;    ///< In the move table.
  bool force = false; ///< Nothing is waited for to be stop-safe.
  std::vector<moved_step> steps;
  size_t open = 0;                ///< Parts of the present stage.
  std::optional<failure> problem; ///< The first.
  /// Called once, when nothing of the move goes on: all run, or some do not.
  completion_handler done;
};

using move_ptr = std::shared_ptr<task_move>;
using move_stage_handler = void (*)(coordinator_pointer, const move_ptr&);
using task_question = bool (task_table::*)(const std::string&) const;

/// What a task must still be for the move to go on.
task_question still_of(const task_move& move);

/// Keeps the first problem.
void add_problem(const move_ptr& move, failure why);

/// Counts down the parts of a stage; after the last one comes the next stage,
/// or `otherwise` if something has gone wrong.
void end_part(coordinator_pointer self, const move_ptr& move,
              move_stage_handler next, move_stage_handler otherwise);

/// The request that a task was made by; none if its record is damaged, or of
/// another version.
std::optional<task_request> request_of(const task_entry& entry);

failure without_request(const std::string& task);

/// Why nothing of the task is started any more; null: its time is not over.
std::optional<failure> why_too_late(const cell_coordinator_state& st,
                                    const std::string& task);

/// Adds a step of a task that is to take the place of an instance, resolved
/// anew, with the ends that it has. It is placed on the node of that name, or
/// anywhere if that is empty.
std::optional<failure> add_moved_step(coordinator_pointer self, task_move& move,
                                      const task_request& request,
                                      const deployment& old,
                                      const std::string& only_on);

/// The step of an instance, with the builds that can do it now; none if there
/// are none.
std::optional<resolved_step> resolve_anew(const cell_coordinator_state& st,
                                          const task_request& request,
                                          const deployment& old);

/// Steps of one task that share files get the same number.
void bind_together(const std::string& task, std::vector<resolved_step>& steps);

/// The same for all steps of a move, whose tasks have numbers of their own.
void keep_together(task_move& move);

// The end of a move, as a whole or step by step.

/// All of it is done, or needs nothing any more.
void end_move(coordinator_pointer self, const move_ptr& move);

void fail_move(coordinator_pointer self, const move_ptr& move,
               const failure& why);

/// These steps run anew, and that is on disk: where a new one has taken the old
/// one's place the old one goes, else the new one: its task was terminated, or
/// the old one has done its work. Then comes `next`.
///
/// In between anything may end, be terminated or lost: what is to go and cannot
/// be told so is told when it registers.
void complete_steps(coordinator_pointer self, const move_ptr& move,
                    const std::vector<size_t>& steps, move_stage_handler next);

/// The new ones of these steps are not wanted: they go, and their records.
void drop_new(coordinator_pointer self, const move_ptr& move,
              const std::vector<size_t>& steps);

/// The move has a problem: what of it has not moved yet stays where it was. A
/// step whose old instance has ended for it has failed by that; one that is
/// still to end is started anew when it has.
void undo_move(coordinator_pointer self, const move_ptr& move);

/// A move of lost steps: the new ones are in the tables, whatever becomes of
/// them. What has not come up is placed once more.
void complete_lost(coordinator_pointer self, const move_ptr& move);

// The placement of a move.

/// Finds places for the steps, and has the members keep room. Then comes
/// `next`, while the placement lock is held; or the move has failed.
///
/// In between tasks are terminated, steps end, and nodes leave: what needs no
/// place any more is left out when the places are known.
void place_move(coordinator_pointer self, const move_ptr& move,
                move_stage_handler next);

// The whole move, stage by stage.

/// The move has the placement lock, and its steps. `done` is called once, with
/// the first problem or null; each stage ends, at the latest with its deadline.
void run_move(coordinator_pointer self, const move_ptr& move);

} // namespace roscell
