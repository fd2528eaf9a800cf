#pragma once

#include "actors/requests/handlers/task_pipeline.hpp"

namespace roscell {

/// The instances that an allocation asks for, in the order of the steps, each
/// with an id of its own.
std::vector<instance_spec> make_specs(const allocated_task& task);

/// `base` with the members of `override` put over it; both are JSON objects or
/// empty.
std::string merge_parameters(const std::string& base,
                             const std::string& override_text);

} // namespace roscell
