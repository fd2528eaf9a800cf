#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/failure.hpp"
#include "messages/skill.hpp"

#include <optional>
#include <string>

namespace roscell {

/// Why an instance of that model cannot be given these parameters, an object,
/// while it runs: names that are not known, values that cannot be, parameters
/// that are not changeable, and programs that take none. Null: it can. Places
/// are those of a `parameter_change`.
std::optional<failure> refused_parameters(const skill_descriptor& skill,
                                          const std::string& model,
                                          const json& wanted);

/// Whether the model has a parameter that can be changed while it runs.
bool has_changeable_parameter(const skill_descriptor& skill,
                              const std::string& model);

/// Values of parameters as an event tells them: of long ones what they are, and
/// not too many.
json short_values(const json& values);

} // namespace roscell
