#pragma once

#include "actors/placement/limits.hpp"
#include "messages/allocation_report.hpp"
#include "messages/failure.hpp"
#include "messages/inside/placement.hpp"

#include <chrono>
#include <functional>
#include <string>
#include <variant>

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

} // namespace roscell
