#include "actors/placement/reading/changeable_parameters.hpp"

#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>

namespace roscell {

namespace {

constexpr const char* apply_instead =
    "change the task's file and `roscell apply` it: that restarts the step";

const implementation_model* model_of(const skill_descriptor& skill,
                                     const std::string& name) {
  const auto found =
      std::find_if(skill.models.begin(), skill.models.end(),
                   [&](const auto& x) { return x.name == name; });
  return found == skill.models.end() ? nullptr : &*found;
}

/// "blur, decimation"
std::string changeable_names(const declared_parameters& known) {
  std::string result;
  for (const auto& [name, x] : known)
    if (x.changeable)
      result += (result.empty() ? "" : ", ") + name;
  return result;
}

/// Why no program of such a skill takes any.
std::optional<failure> refused_program(const skill_descriptor& skill) {
  if (!skill.ros2.empty())
    return failure{
        error_code::conflict,
        "'" + skill.operation
            + "' is a ROS 2 program, which has parameters of its own",
        "/instance", "`ros2 param set` changes them"};
  if (skill.engine == "actor")
    return failure{error_code::conflict,
                   "'" + skill.operation
                       + "' is an actor, which takes no parameters while it "
                         "runs",
                   "/instance", apply_instead};
  return std::nullopt;
}

failure unchangeable(const std::string& name,
                     const declared_parameters& known) {
  const auto others = changeable_names(known);
  return {error_code::schema_violation,
          "'" + name + "' cannot be changed while the skill runs; "
              + (others.empty() ? "no parameter of it can"
                                : "what can is " + others),
          (json::json_pointer{"/parameters"} / name).to_string(),
          apply_instead};
}

} // namespace

std::optional<failure> refused_parameters(const skill_descriptor& skill,
                                          const std::string& model,
                                          const json& wanted) {
  const auto* found = model_of(skill, model);
  if (found == nullptr)
    return failure{error_code::unknown_model,
                   "the skill has no model '" + model + "' any more",
                   "/instance", apply_instead};
  if (auto why = refused_program(skill))
    return why;
  const auto known = parameters_of(skill, *found);
  const auto errors = parameter_errors(known, wanted, "/parameters");
  if (!errors.empty())
    return failure{error_code::schema_violation, errors.front().expected,
                   errors.front().pointer,
                   "`roscell skill show " + skill.operation
                       + "` lists its parameters"};
  for (const auto& [name, value] : wanted.items())
    if (!known.at(name).changeable)
      return unchangeable(name, known);
  return std::nullopt;
}

bool has_changeable_parameter(const skill_descriptor& skill,
                              const std::string& model) {
  const auto* found = model_of(skill, model);
  return found != nullptr && !refused_program(skill)
         && !changeable_names(parameters_of(skill, *found)).empty();
}

json short_values(const json& values) {
  constexpr size_t most = 16;
  constexpr size_t most_bytes = 200;
  auto result = json::object();
  for (const auto& [name, value] : values.items()) {
    if (result.size() == most)
      break;
    const auto text =
        value.dump(-1, ' ', false, json::error_handler_t::replace);
    result[name] = text.size() > most_bytes ? json(shown_value(value)) : value;
  }
  return result;
}

} // namespace roscell
