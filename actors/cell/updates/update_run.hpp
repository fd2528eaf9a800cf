#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "actors/cell/updates/update_order.hpp"
#include "actors/cell/updates/update_plan.hpp"
#include "messages/failure.hpp"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// INTERNAL to updates: one update of a task, from its request to its end.
namespace roscell {

/// What the messages of one update carry along. How far it is stands in the
/// update table.
struct update_run {
  uint64_t id = 0; ///< In the update table; 0: it is only shown.
  task_update asked;
  task_request request; ///< What the task is to be.
  std::string body;     ///< The request as it is stored.
  update_plan plan;
  uint64_t placement_lock = 0;
  bool cpu_floor = false; ///< As in `task_plan`.

  std::vector<replaced_step> steps;
  std::vector<step_allocation> places; ///< Of each step; unused if it has none.
  std::vector<std::vector<size_t>> waves; ///< Positions in `steps`.
  size_t wave = 0;                        ///< The present one.

  size_t open = 0;                ///< Parts of the present stage.
  std::optional<failure> problem; ///< The first.
  /// What must run of the present wave before a new one starts, for each.
  std::vector<std::vector<size_t>> before;
};

using update_ptr = std::shared_ptr<update_run>;

const std::string& task_of(const update_run& run);

/// What is to be replaced: the new instances and the ones they replace.
std::vector<replacement> replacements_of(const update_run& run);

// Planning.

/// Reads the request and compares it with what runs. Errors as those of the
/// message.
std::optional<failure> plan_changes(coordinator_pointer self, update_run& run);

/// Finds places for what is new, as if what it replaces had ended: where it
/// was, if it fits there. Then comes `next`, with what is wrong if there are
/// none.
void place_update(coordinator_pointer self, const update_ptr& run,
                  const completion_handler& next);

/// What is answered about it.
task_update_plan report_of(const cell_coordinator_state& st,
                           const update_run& run, update_outcome outcome);

// The waves. Each begins by asking the table whether the update goes on.

/// The plan is written down: its first wave begins.
void open_next_wave(coordinator_pointer self, const update_ptr& run);

/// Positions in `steps` of the present wave.
const std::vector<size_t>& wave_of(const update_run& run);

/// What has gone wrong with one of the steps.
failure step_failure(const update_run& run, size_t i, const failure& why);

/// The nodes of the present wave get the builds that they lack, its old
/// instances end, its nodes keep room, and its new ones start; then it settles,
/// or all is undone.
void begin_wave(coordinator_pointer self, const update_ptr& run);

/// The new instances of the wave run, and are to do so for a while.
void settle_wave(coordinator_pointer self, const update_ptr& run);

/// Why a new instance does not do its work; null: it does, or has done it.
std::optional<failure> why_unwell(const cell_coordinator_state& st,
                                  const replaced_step& x);

/// Something has gone wrong: what is new goes, and what it has replaced is
/// started again on its node, or where it fits. Nothing happens if that is
/// being done, or the update has ended.
void undo_update(coordinator_pointer self, const update_ptr& run,
                 const failure& why);

/// Nothing of it goes on any more.
void end_update(coordinator_pointer self, const update_ptr& run);

} // namespace roscell
