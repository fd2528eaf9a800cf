#pragma once

#include "messages/failure.hpp"
#include "messages/inside/placement.hpp"

#include <optional>
#include <variant>
#include <vector>

namespace roscell {

/// Finds for each step the builds that can do it, with their deployments to
/// choose from. On each node the candidate is, of the builds that fit the step,
/// the one that was added last, so builds for other architectures and other
/// versions do not keep each other from being chosen. `where` of an error
/// points below `pointer`, the JSON pointer of the pipeline.
///
/// Errors: unknown_operation (also where no build has the digits that the step
/// names; the hint tells what nodes have refused), unknown_model,
/// unknown_deployment, and schema_violation for a protocol or data type that
/// the skill does not take.
std::variant<std::vector<resolved_step>, failure>
resolve_steps(const std::vector<task_step>& pipeline, const skill_list& skills,
              const std::string& pointer = "/pipeline");

// How a step is to live: what its request says, over what its skill says, over
// the defaults.

/// Both have passed their schemas.
life_policy life_of(const task_step& step, const deployment_option& option,
                    bool safe_state);

/// Why a step cannot live so. `where` is relative to the step.
/// Errors: schema_violation.
std::optional<failure> check_life(const task_step& step,
                                  const deployment_option& option,
                                  const skill_descriptor& descriptor);

} // namespace roscell
