#pragma once

#include "actors/placement/reading/short_forms.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/schema_error.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A step with the values that its parameters have: the declared defaults, and
/// what the step gives.
struct valued_step {
  const written_step& written;
  json values;
};

/// Where one step sends images in an encoding that another, which reads them,
/// does not take. What a step sends is its parameter `encoding`, what it takes
/// its parameter `encodings`, a list; a step without them sends and takes any.
std::vector<schema_error>
encoding_errors(const std::vector<valued_step>& steps);

} // namespace roscell
