#pragma once

#include "messages/codec/json_codec.hpp"
#include "messages/skill.hpp"
#include "schemas/validator.hpp"

#include <limits>
#include <map>
#include <string>
#include <vector>

namespace roscell {

/// One parameter of a model, as a descriptor declares it.
struct declared_parameter {
  std::string type; ///< As JSON Schema names it; empty: any.
  json value;       ///< The default; null: none.
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  std::vector<json> values; ///< All that it can be; empty: no list.
  std::string unit;
  std::string description;
  bool changeable = false;  ///< While the skill runs.
  std::string items;        ///< Type of a list's items; empty: any.
  bool is_declared = false; ///< By an object, not by its default alone.
};

/// By name.
using declared_parameters = std::map<std::string, declared_parameter>;

/// Reads `parameters` of a model, an object that its schema allows. What is no
/// declaration is a default, whose type the parameter has; what an engine
/// declares of a parameter of that name stays (`known`).
declared_parameters read_parameters(const json& parameters,
                                    const declared_parameters& known = {});

/// What a value of it must be: `a number from 0 to 100 (m)`.
std::string parameter_text(const declared_parameter& x);

/// What is wrong with a value; empty if nothing is.
std::string value_problem(const declared_parameter& x, const json& value);

/// What is wrong with the declarations themselves, such as a default outside
/// its range. Pointers begin with `place`.
std::vector<schema_error> declaration_errors(const json& parameters,
                                             const std::string& place);

/// The defaults of a model as a step begins with them.
json parameter_defaults(const json& parameters);

/// What an instance gets: the defaults, with what its step says put over them.
/// @param model, step JSON objects as text; empty: none.
json step_parameters(const std::string& model, const std::string& step);

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

// Values as a ROS 2 program takes them: `-p NAME:=VALUE`, which rcl reads as
// YAML and types by its form, or `NAME:=VALUE` of a launch file, which is text
// that launch reads as YAML where it becomes a parameter.

enum class ros_reader { program, launch_file };

/// Why a value cannot be given so; empty: it can. rcl knows no objects, no
/// lists in lists, of mixed types or without an item, and neither knows null;
/// no argument of a program has a NUL.
std::string ros_problem(const json& value, ros_reader reader);

/// The same for all of an object. Pointers begin with `place`.
std::vector<schema_error> ros_errors(const json& values, ros_reader reader,
                                     const std::string& place);

/// The text of a value without a problem, in the type that is declared: 2 for a
/// number is "2.0". Where nothing is declared but a default, the form of that
/// counts. Text for a launch file is in quotes if YAML would take it for
/// something else.
/// @param declared null: nothing is known of it.
std::string ros_text(const json& value, const declared_parameter* declared,
                     ros_reader reader);

} // namespace roscell
