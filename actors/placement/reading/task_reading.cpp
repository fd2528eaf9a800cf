#include "actors/placement/reading/task_reading.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "actors/placement/reading/wiring.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "messages/stream_protocols.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/text_excerpt.hpp"

#include <algorithm>
#include <cstddef>
#include <string>
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

/// Linux gives a program no longer variable (MAX_ARG_STRLEN), and its name is
/// to fit, too.
constexpr size_t most_variable_bytes = 128UL * 1024 - 64;

ros_reader reader_of(const ros2_program& program) {
  return program.launch.empty() ? ros_reader::program : ros_reader::launch_file;
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
  const auto given = json::parse(x.step.parameters);
  auto result =
      parameter_errors(parameters_of(*skill, build.model), given, place);
  if (!result.empty() || skill->engine == "actor")
    return result;
  if (!skill->ros2.empty())
    result = ros_errors(given, reader_of(skill->ros2.front()), place);
  const auto bytes =
      step_parameters(build.model.parameters, x.step.parameters).dump().size();
  if (bytes > most_variable_bytes)
    result.push_back({place, "expected at most 128 KiB of parameters, which a "
                             "program gets in one variable, got "
                                 + std::to_string(bytes / 1024) + " KiB"});
  return result;
}

/// An actor is part of a program that runs already.
error_list program_errors_of(const resolved_step& x, const skill_list& skills,
                             const std::string& place) {
  const auto* skill = find_build(skills, x.builds.front().hash);
  error_list result;
  if (skill == nullptr || skill->engine != "actor")
    return result;
  constexpr const char* why =
      "its skill is an actor of a program that runs already; leave it out";
  if (!x.step.env.empty())
    result.push_back({place + "/env", why});
  if (!x.step.arguments.empty())
    result.push_back({place + "/arguments", why});
  return result;
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

std::string body_of(task_request request) {
  request.preempt = preemption::none;
  request.force = false;
  request.replace = false;
  request.request_id.clear();
  return message_json(request).dump();
}

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
    const auto place = pointer + "/" + std::to_string(i);
    append(errors, parameter_errors_of(result.steps[i], cell.skills,
                                       place + "/parameters"));
    append(errors, program_errors_of(result.steps[i], cell.skills, place));
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

namespace {

bool carries_images(const io_endpoint& x) {
  return x.protocol == protocols::ros2
         && x.data_type == "sensor_msgs/msg/Image";
}

/// None: any.
const json* member_of(const valued_step& x, const char* name, bool is_list) {
  const auto found = x.values.find(name);
  const auto is_there =
      found != x.values.end()
      && (is_list ? found->is_array() && !found->empty() : found->is_string());
  return is_there ? &*found : nullptr;
}

/// The first few, because there may be many.
std::string names_of(const json& list) {
  constexpr size_t shown = 8;
  std::string result;
  for (size_t i = 0; i < std::min(shown, list.size()); ++i)
    result +=
        (i == 0 ? "" : ", ")
        + (list[i].is_string() ? list[i].get<std::string>() : list[i].dump());
  return list.size() > shown ? result + ", ..." : result;
}

void compare(const valued_step& reader, const valued_step& writer,
             std::vector<schema_error>& errors) {
  const auto* taken = member_of(reader, "encodings", true);
  const auto* sent = member_of(writer, "encoding", false);
  if (taken == nullptr || sent == nullptr
      || std::find(taken->begin(), taken->end(), *sent) != taken->end())
    return;
  const auto& inputs = reader.written.step.input;
  const auto& outputs = writer.written.step.output;
  for (size_t i = 0; i < inputs.size(); ++i)
    for (size_t k = 0; k < outputs.size(); ++k)
      if (carries_images(inputs[i]) && carries_images(outputs[k])
          && full_topic(inputs[i].endpoint) == full_topic(outputs[k].endpoint))
        errors.push_back(
            {reader.written.input_at[i],
             "step " + in_quotes(writer.written.step.id) + " (at "
                 + writer.written.output_at[k] + ") sends images in encoding "
                 + in_quotes(sent->get<std::string>()) + ", but step "
                 + in_quotes(reader.written.step.id) + " takes only "
                 + names_of(*taken)
                 + "; change one of them, or put a step of the skill convert "
                   "between them"});
}

} // namespace

std::vector<schema_error>
encoding_errors(const std::vector<valued_step>& steps) {
  std::vector<schema_error> result;
  for (const auto& reader : steps)
    for (const auto& writer : steps)
      compare(reader, writer, result);
  return result;
}

} // namespace roscell
