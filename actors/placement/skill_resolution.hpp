#pragma once

#include "messages/coordination.hpp"
#include "messages/failure.hpp"

#include <variant>
#include <vector>

namespace roscell {

/// Finds for each step the skill, the model and the deployments to choose from.
/// Where nodes have different versions of a skill, the one that most nodes have
/// is taken. `where` of an error points below `pointer`, the JSON pointer of
/// the pipeline.
///
/// Errors: unknown_operation, unknown_model, unknown_deployment, and
/// schema_violation for a protocol or data type that the skill does not take.
std::variant<std::vector<resolved_step>, failure>
resolve_steps(const std::vector<task_step>& pipeline,
              const std::vector<skill_row>& skills,
              const std::string& pointer = "/pipeline");

} // namespace roscell
