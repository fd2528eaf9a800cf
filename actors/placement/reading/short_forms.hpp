#pragma once

#include "messages/skill.hpp"
#include "messages/task.hpp"
#include "schemas/validator.hpp"

#include <string>
#include <vector>

namespace roscell {

/// A step without short forms, and which place of the request each of its ends
/// comes from, as JSON pointers.
struct written_step {
  task_step step;
  std::vector<std::string> input_at;
  std::vector<std::string> output_at;
};

/// A step that has no short forms, wherever it comes from.
written_step as_written(const task_step& step);

struct written_pipeline {
  std::vector<written_step> steps;
  std::vector<schema_error> errors;
};

/// Writes the short forms of a pipeline out by what its skills take and give:
///
/// - an input `{"from": "STEP.OUTPUT"}` becomes that output, `{"from": "STEP"}`
///   every output of it that the reading skill takes. Outputs that the step
///   does not name are topics `/TASK/STEP/OUTPUT` then, and are added to it;
/// - a protocol that is not said is guessed from the form of the endpoint, a
///   data type from a file's ending, from who writes the topic, or from its
///   name, among those that the skill takes or gives there.
///
/// Steps whose skill nobody has stay as they are: to say so is not this one's
/// matter. `pointer` is the JSON pointer of the pipeline.
written_pipeline write_out(const std::string& task,
                           const std::vector<task_step>& pipeline,
                           const skill_list& skills,
                           const std::string& pointer);

} // namespace roscell
