#pragma once

#include "actors/cell/tables/ordered_ends.hpp"
#include "actors/cell/tables/task_table.hpp"
#include "actors/core/backoff.hpp"
#include "messages/failure.hpp"
#include "messages/inside/coordination.hpp"

#include <caf/actor_addr.hpp>
#include <caf/typed_response_promise.hpp>

#include <chrono>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace roscell {

/// Somebody who waits for the placement lock.
struct placement_lock_request {
  uint64_t number = 0;
  caf::actor_addr owner;       ///< Null: the coordinator itself.
  std::function<void()> begin; ///< Called once, when it has the lock.
};

/// Who works on a task, and who waits for what becomes of it.
struct task_waiters {
  caf::actor_addr owner;       ///< The pipeline that deploys it.
  uint64_t placement_lock = 0; ///< That it was given.
  bool force = false;          ///< It is ended without waiting for safety.
  /// The run before the one that is being deployed; none: this is the first.
  std::optional<task_record> former;
  std::vector<caf::typed_response_promise<task_claimed>> same_requests;
  std::vector<caf::typed_response_promise<task_terminated>> terminations;
  /// Called once all of it is gone.
  std::vector<std::function<void()>> gone;
};

/// A change of a task's record that is to be written.
struct pending_change {
  /// Whether it still applies; asked when its turn has come. Null: always.
  bool (task_table::*still)(const std::string&) const = nullptr;
  /// From the record as it is to the one that shall be; empty: it is removed.
  std::function<task_record(task_record)> make;
  /// Tried until the store has kept it.
  bool insistent = false;
  /// Takes up all ends that are told until it is written.
  bool takes_ends = false;
  /// Called once: when the store has kept it and the tables show it, or when it
  /// is not written any more. May be empty.
  completion_handler done;
  /// Told of every try that failed, of one that is tried again.
  std::function<void(const failure&)> on_problem;
};

/// Changes of one task, one after the other.
struct change_line {
  std::deque<pending_change> changes; ///< The first is being written.
  bool writing = false;
  backoff pause;
  /// When the first one is tried again.
  std::chrono::steady_clock::time_point retry =
      std::chrono::steady_clock::time_point::max();
};

/// Somebody waits until nothing is being deployed to a node. Called once.
struct awaited_deployments {
  std::string node;
  std::function<void()> done;
};

/// Somebody waits until an instance, which is not stop-safe yet, is gone.
/// Called once: then, or when the time is over.
struct awaited_safety {
  safety_wait wait;
  std::function<void()> done; ///< Null: nobody waits any more.
  std::chrono::steady_clock::time_point until =
      std::chrono::steady_clock::time_point::max();
};

/// Parameters of an instance that are being changed.
struct parameter_change_run {
  std::string task;
  /// Its node has registered meanwhile, and is told once it is over what the
  /// task says.
  bool restate = false;
};

/// What of the coordinator's work on tasks goes on at present.
struct pending_operations {
  uint64_t last_placement_lock = 0;
  uint64_t placement_lock = 0; ///< Of who is placing; 0: nobody.
  std::deque<placement_lock_request> waiting;
  std::map<std::string, task_waiters> waiters; ///< By task.
  std::map<std::string, change_line> lines;    ///< The same.
  removal_table removals;
  /// Tasks that are no more and may run on, and until when. max(): until their
  /// nodes say so.
  std::map<std::string, std::chrono::steady_clock::time_point> remains;
  std::vector<awaited_safety> not_stop_safe;
  std::vector<awaited_deployments> deployments_awaited;
  /// By instance.
  std::map<std::string, parameter_change_run> parameter_changes;
};

/// When a change is to be tried again; time_point::max(): none waits for that.
std::chrono::steady_clock::time_point
next_change_retry(const pending_operations& pending);

/// When what is left of a task has surely ended; max(): nothing is left, or its
/// node has to say so.
std::chrono::steady_clock::time_point
next_end_of_remains(const pending_operations& pending);

/// When somebody who waits for an instance to be stop-safe has waited for too
/// long.
std::chrono::steady_clock::time_point
next_safety_deadline(const pending_operations& pending);

} // namespace roscell
