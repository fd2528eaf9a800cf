#pragma once

#include "messages/skill_descriptor.hpp"
#include "schemas/parameters/declared_parameter.hpp"

#include <string>
#include <vector>

namespace roscell {

/// What a step may set for a model: what the model declares, and what its
/// skill's engine and the protocols that the skill speaks understand.
declared_parameters parameters_of(const skill_descriptor& skill,
                                  const implementation_model& model);

/// What is wrong with the parameters that a step gives, an object: names that
/// are not known, with the one that was probably meant, and values. Pointers
/// begin with `place`.
std::vector<schema_error> parameter_errors(const declared_parameters& known,
                                           const json& given,
                                           const std::string& place);

} // namespace roscell
