#include "actors/placement/reading/task_reading.hpp"

#include "actors/placement/reading/image_encodings.hpp"
#include "actors/placement/reading/wiring.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "schemas/parameters/engine_parameters.hpp"

#include <utility>

namespace roscell {

namespace {

using error_list = std::vector<schema_error>;

void append(error_list& errors, const error_list& others) {
  errors.insert(errors.end(), others.begin(), others.end());
}

const skill_descriptor* find_build(const skill_list& skills,
                                   const std::string& hash) {
  for (const auto& row : skills.skills)
    if (row.skill.hash == hash)
      return &row.skill.descriptor;
  return nullptr;
}

/// By what the newest build declares.
error_list parameter_errors_of(const resolved_step& x, const skill_list& skills,
                               const std::string& place) {
  if (x.step.parameters.empty())
    return {};
  const auto& build = x.builds.front();
  const auto* skill = find_build(skills, build.hash);
  if (skill == nullptr)
    return {};
  return parameter_errors(parameters_of(*skill, build.model),
                          json::parse(x.step.parameters), place);
}

/// By the newest build.
json values_of(const resolved_step& x) {
  const auto& model = x.builds.front().model;
  auto result = model.parameters.empty()
                    ? json::object()
                    : parameter_defaults(json::parse(model.parameters));
  if (!x.step.parameters.empty())
    result.update(json::parse(x.step.parameters));
  return result;
}

std::vector<task_step> steps_of(const written_pipeline& x) {
  std::vector<task_step> result;
  for (const auto& written : x.steps)
    result.push_back(written.step);
  return result;
}

} // namespace

std::variant<task_reading, failure>
read_task(const std::string& task, const std::vector<task_step>& pipeline,
          const reading_context& cell, const std::string& pointer) {
  const auto written = write_out(task, pipeline, cell.skills, pointer);
  if (!written.errors.empty())
    return to_failure(written.errors);
  auto resolved = resolve_steps(steps_of(written), cell.skills, pointer);
  if (auto* why = std::get_if<failure>(&resolved))
    return std::move(*why);
  task_reading result;
  result.steps = std::get<std::vector<resolved_step>>(std::move(resolved));
  auto wires = find_wiring(task, written.steps, cell.written, cell.topics);
  error_list errors;
  for (size_t i = 0; i < result.steps.size(); ++i) {
    result.steps[i].together = wires.together[i];
    append(errors, parameter_errors_of(result.steps[i], cell.skills,
                                       pointer + "/" + std::to_string(i)
                                           + "/parameters"));
  }
  append(errors, wires.errors);
  std::vector<valued_step> valued;
  for (size_t i = 0; i < result.steps.size(); ++i)
    valued.push_back({written.steps[i], values_of(result.steps[i])});
  append(errors, encoding_errors(valued));
  if (!errors.empty())
    return to_failure(errors);
  result.warnings = std::move(wires.warnings);
  return result;
}

} // namespace roscell
