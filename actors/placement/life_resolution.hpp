#pragma once

#include "messages/failure.hpp"
#include "messages/inside/placement.hpp"

#include <optional>

/// How a step is to live: what its request says, over what its skill says, over
/// the defaults.
namespace roscell {

/// Both have passed their schemas.
life_policy life_of(const task_step& step, const deployment_option& option,
                    bool safe_state);

/// Why a step cannot live so. `where` is relative to the step.
/// Errors: schema_violation.
std::optional<failure> check_life(const task_step& step,
                                  const deployment_option& option,
                                  const skill_descriptor& descriptor);

} // namespace roscell
