#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// INTERNAL to task_move and task_restart: how instances take the places of
/// others, from the search for places on.
namespace roscell {

/// One instance that takes another one's place.
struct moved_step {
  std::string task;
  resolved_step step;
  replacement change;
  std::string from;       ///< Node of the old one.
  bool was_there = false; ///< That node was no lost one when this began.
  bool is_up = false;     ///< The new one runs.
};

/// What the replaced instances do.
enum class move_kind {
  leaving,   ///< They run until the new ones do.
  restarted, ///< They have ended.
  lost,      ///< Nobody knows, and they end when they come back.
};

/// One move, as it goes on. Each of its stages waits for all steps.
struct task_move {
  std::string what; ///< Whose instances they are, for errors.
  move_kind kind = move_kind::leaving;
  uint64_t turn = 0;
  std::vector<std::string> tasks;
  bool ends_first = false; ///< The old ones end before the new ones start.
  bool force = false;      ///< Nothing is waited for to be safe.
  std::vector<moved_step> steps;
  size_t open = 0;
  std::optional<failure> problem; ///< The first.
  std::function<void(const failure*)> done;
};

using move_ptr = std::shared_ptr<task_move>;
using move_stage = void (*)(coordinator_pointer, const move_ptr&);

using task_question = bool (task_book::*)(const std::string&) const;

/// What takes which places, by task.
std::map<std::string, std::vector<replacement>> by_task(const task_move& move);

/// What a task must still be for the move to go on.
task_question still_of(const task_move& move);

void fail_move(coordinator_pointer self, const move_ptr& move,
               const failure& why);

/// Keeps the first problem.
void add_problem(const move_ptr& move, failure why);

/// Counts down the parts of a stage; after the last one comes the next stage,
/// or `otherwise` if something has gone wrong.
void end_part(coordinator_pointer self, const move_ptr& move, move_stage next,
              move_stage otherwise);

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

/// Finds places for the steps and has the members keep room; then the stages
/// below. Ends the turn.
void place_move(coordinator_pointer self, const move_ptr& move);

/// The request that a task was made by; none if its record is of another
/// version.
std::optional<task_request> request_of(const task_entry& entry);

/// Stores the new instances beside the old ones, starts them, stores them
/// instead of the old ones, and ends these.
void hold_steps(coordinator_pointer self, const move_ptr& move);

/// Where a new one has taken the old one's place the old one goes, else the new
/// one: its task was terminated, or the old one has done its work.
void complete_move(coordinator_pointer self, const move_ptr& move);

/// The same of a lost node: the new ones are in the books, whatever becomes of
/// them.
void complete_lost(coordinator_pointer self, const move_ptr& move);

/// Takes all of it back, for a move that has a problem: nothing has changed,
/// but that room may have been kept for nothing.
void undo_move(coordinator_pointer self, const move_ptr& move);

} // namespace roscell
