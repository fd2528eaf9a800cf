#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// INTERNAL to task_move: how a move goes on once it is known where to.
namespace roscell {

/// One instance that moves.
struct moved_step {
  std::string task;
  resolved_step step;
  replacement change;
};

/// One move, as it goes on. Each of its stages waits for all steps.
struct task_move {
  std::string node; ///< That is being left.
  uint64_t turn = 0;
  std::vector<std::string> tasks;
  std::vector<moved_step> steps;
  size_t open = 0;
  std::optional<failure> problem; ///< The first.
  std::function<void(const failure*)> done;
};

using move_ptr = std::shared_ptr<task_move>;
using move_stage = void (*)(coordinator_pointer, const move_ptr&);

void fail_move(coordinator_pointer self, const move_ptr& move,
               const failure& why);

/// Keeps the first problem.
void add_problem(const move_ptr& move, failure why);

/// Counts down the parts of a stage; after the last one comes the next stage,
/// or `otherwise` if something has gone wrong.
void end_part(coordinator_pointer self, const move_ptr& move, move_stage next,
              move_stage otherwise);

/// Stores the new instances beside the old ones, starts them, stores them
/// instead of the old ones, and ends these.
void hold_steps(coordinator_pointer self, const move_ptr& move);

/// Takes all of it back.
void undo_move(coordinator_pointer self, const move_ptr& move);

} // namespace roscell
