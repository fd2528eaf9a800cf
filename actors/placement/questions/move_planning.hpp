#pragma once

#include "actors/placement/limits.hpp"
#include "messages/failure.hpp"
#include "messages/inside/placement.hpp"

#include <chrono>
#include <functional>
#include <variant>

namespace roscell {

/// Moves that bring running steps nearer to the optimum of equations (1) to
/// (4), all steps taken as one task. Steps that run where a new one could not
/// be placed stay there. `cancelled` may be empty. Errors: conflict (they do
/// not fit as they run).
std::variant<moves_planned, failure>
plan_better_moves(const plan_moves& asked,
                  std::chrono::milliseconds budget = limits::task::move_budget,
                  const std::function<bool()>& cancelled = {});

} // namespace roscell
