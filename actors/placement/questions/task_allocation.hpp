#pragma once

#include "actors/placement/limits.hpp"
#include "actors/placement/search/problem.hpp"
#include "messages/allocation_report.hpp"
#include "messages/failure.hpp"
#include "messages/inside/placement.hpp"

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace roscell {

/// Runs the search of actors/allocation on messages, and another one for the
/// alternative where one is asked for. `cancelled` may be empty; true ends the
/// search with the best that was found. Where the steps do not fit, what may be
/// evicted is, as `evict_for` says, and the plan names it. Errors:
/// no_feasible_allocation with `rejected` in its details, schema_violation for
/// numbers that make no sense and for an unknown step, timeout.
std::variant<task_plan, failure>
allocate(const allocate_task& asked,
         std::chrono::milliseconds budget = limits::task::allocation_budget,
         const std::function<bool()>& cancelled = {});

/// The same for a cell on paper, where every node has every skill. `why` is a
/// step whose best alternative is asked for, or empty. Errors: also those of
/// `resolve_steps`.
std::variant<task_plan, failure> allocate_offline(const plan_document& document,
                                                  const std::string& why = {});

/// What is preempted for a task, and the problem without it.
struct task_eviction {
  allocation::problem problem;
  std::vector<preempted_instance> preempted;
  bool optimal = true; ///< No cheaper one does.
};

/// What must go before a task fits: instances whose priority is lower than that
/// of each of its steps. Nothing if that is not enough, or not found in time.
std::optional<task_eviction> evict_for(const allocate_task& asked,
                                       const allocation::problem& problem,
                                       const allocation::limits& limits);

/// Moves that bring running steps nearer to the optimum of equations (1) to
/// (4), all steps taken as one task. Steps that run where a new one could not
/// be placed stay there. `cancelled` may be empty. Errors: conflict (they do
/// not fit as they run).
std::variant<moves_planned, failure>
plan_better_moves(const plan_moves& asked,
                  std::chrono::milliseconds budget = limits::task::move_budget,
                  const std::function<bool()>& cancelled = {});

} // namespace roscell
