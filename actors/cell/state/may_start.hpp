#pragma once

#include "actors/cell/state/coordinator_state.hpp"
#include "messages/failure.hpp"

#include <chrono>
#include <optional>
#include <string>
#include <vector>

/// Whether an instance may be started now: nothing of a step is while another
/// instance of it may run. Whoever starts one asks here first; the node failure
/// table (`st.failures`) knows what may run where, these functions publish to
/// it what starts and ends, and write to the store what outlives its task.
namespace roscell {

/// Whether it may be placed anew where its node is lost.
bool may_move(const instance_spec& x);

/// How long it may run on there after the last word, if it may.
std::chrono::milliseconds fence_of(const instance_spec& x);

/// Whether its host may start it without the coordinator.
bool starts_alone(const instance_spec& x);

/// Whose place an instance takes.
struct start_request {
  std::string task;
  std::string step;
  std::string replaces; ///< Empty: nobody's.
  /// That one runs on until the new one does, as long as its node is there.
  bool beside = false;
};

/// Why it must not be started now; null: it may.
std::optional<failure> why_not_yet(coordinator_pointer self,
                                   const start_request& request);

/// It is about to be told to start there. False: too many are known.
bool note_start(coordinator_pointer self, const instance_spec& spec,
                const std::string& node);

/// A node has told of it. What has ended may have a successor.
void note_reported(coordinator_pointer self, const instance_row& row,
                   const std::string& node);

/// It has ended there, which may have been the last one of a task that is no
/// more.
void note_gone(coordinator_pointer self, const std::string& uuid,
               const std::string& instance);

/// Whether it surely does not run.
bool is_surely_gone(coordinator_pointer self, const std::string& instance);

/// Why a task must not be begun yet: a step of its name that nobody wants any
/// more may still run.
/// @param force Hosts that would start one alone are off, somebody says.
std::optional<failure> remains_of(coordinator_pointer self,
                                  const std::string& task, bool force);

/// The record of a task, with what it has given up and may run on.
task_record with_left(coordinator_pointer self, task_record record);

/// Where instances of stored tasks may run, as the coordinator starts; also of
/// those that it drops.
void restore_places(coordinator_pointer self,
                    const std::vector<task_record>& stored);

// Of a task that is no more what may run on, where its node is away, is
// remembered until it surely has ended: also over restarts of the coordinator.
// Until then no step of that name is started.

/// What the store is to have of a task that is no more: nothing, or where it
/// may run on.
store_record record_of_remains(coordinator_pointer self,
                               const std::string& task);

/// Forgets what its fence has ended, and removes what is remembered of tasks
/// that surely run nowhere by now. A task that was begun anew has a record of
/// its own.
void forget_past_remains(coordinator_pointer self);

} // namespace roscell
