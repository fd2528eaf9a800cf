#pragma once

#include "actors/placement/reading/short_forms.hpp"
#include "messages/failure.hpp"
#include "messages/inside/placement.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/validator.hpp"

#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace roscell {

/// A request as it is meant: without short forms, its skills found, its
/// parameters and wiring checked.
struct task_reading {
  std::vector<resolved_step> steps;
  std::vector<std::string> warnings;
};

/// What there is in a cell that a request can speak of.
struct reading_context {
  skill_list skills;
  std::vector<deployed_end> written; ///< By the steps of its tasks.
  /// Topics that anybody writes; none: nobody knows.
  std::optional<std::vector<io_endpoint>> topics;
};

/// What tells a request from another one of its task, as JSON: the way in which
/// it is carried out does not.
std::string body_of(task_request request);

/// Reads a pipeline. Errors: those of `resolve_steps`, and schema_violation
/// with every place where a short form, a parameter or the wiring is wrong;
/// pointers begin with `pointer`.
std::variant<task_reading, failure>
read_task(const std::string& task, const std::vector<task_step>& pipeline,
          const reading_context& cell,
          const std::string& pointer = "/pipeline");

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
