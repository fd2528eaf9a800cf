#pragma once

#include "messages/codec/json_codec.hpp"
#include "schemas/schema_error.hpp"

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

} // namespace roscell
