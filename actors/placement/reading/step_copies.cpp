#include "actors/placement/reading/step_copies.hpp"

#include "schemas/reading/placeholder.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <utility>

namespace roscell {

namespace {

constexpr const char* placeholder = "copy";
/// As schemas/common.schema.json has it.
constexpr size_t longest_id = 63;
constexpr size_t most_steps = 128;

std::optional<failure> refuse(const std::string& at, std::string why,
                              std::string hint) {
  return failure{error_code::schema_violation, std::move(why), at,
                 std::move(hint)};
}

std::string id_of(const task_step& step, int64_t copy) {
  return step.id + "-" + std::to_string(copy);
}

std::string place_of(const std::vector<io_endpoint>& ends, size_t i,
                     const std::string& at) {
  return ends.size() == 1 ? at : at + "/" + std::to_string(i);
}

/// A stream has one writer.
std::optional<failure> check_outputs(const task_step& step,
                                     const std::string& at) {
  for (size_t i = 0; i < step.output.size(); ++i) {
    const auto& end = step.output[i].endpoint;
    if (!end.empty() && !has_placeholder(end, placeholder))
      return refuse(place_of(step.output, i, at + "/output"),
                    "all " + std::to_string(step.copies) + " copies of step '"
                        + step.id + "' would write '" + end + "'",
                    "put ${copy} into it: each copy has its number there");
  }
  return std::nullopt;
}

/// Nobody reads all copies of a step by its name alone.
std::optional<failure> check_inputs(const std::vector<task_step>& pipeline,
                                    const task_step& step,
                                    const std::string& at) {
  for (size_t i = 0; i < step.input.size(); ++i)
    for (const auto& writer : pipeline) {
      const auto& from = step.input[i].from;
      const bool is_meant =
          from == writer.id
          || from.compare(0, writer.id.size() + 1, writer.id + ".") == 0;
      if (writer.copies > 1 && is_meant)
        return refuse(place_of(step.input, i, at + "/input") + "/from",
                      "step '" + writer.id + "' has "
                          + std::to_string(writer.copies) + " copies",
                      "name one of them, such as '" + id_of(writer, 1)
                          + "', or '" + writer.id
                          + "-${copy}' in a step with as many copies");
    }
  return std::nullopt;
}

std::optional<failure> check_step(const std::vector<task_step>& pipeline,
                                  const task_step& step,
                                  const std::string& at) {
  if (auto why = check_inputs(pipeline, step, at))
    return why;
  if (step.copies == 1)
    return std::nullopt;
  if (id_of(step, step.copies).size() > longest_id)
    return refuse(at + "/id",
                  "with the number of a copy it is longer than "
                      + std::to_string(longest_id) + " characters",
                  "give the step a shorter id");
  return check_outputs(step, at);
}

task_step copy_of(const task_step& step, int64_t number) {
  auto alone = step;
  alone.copies = 1;
  json document = alone;
  if (auto given = document.find("parameters"); given != document.end())
    fill_placeholder(*given, placeholder, number);
  fill_placeholder(document, placeholder, std::to_string(number));
  auto result = document.get<task_step>();
  result.id = id_of(step, number);
  return result;
}

} // namespace

std::variant<std::vector<task_step>, failure>
with_copies(const std::vector<task_step>& pipeline,
            const std::string& pointer) {
  std::vector<task_step> result;
  std::set<std::string> ids;
  for (size_t i = 0; i < pipeline.size(); ++i) {
    const auto& step = pipeline[i];
    const auto at = pointer + "/" + std::to_string(i);
    if (auto why = check_step(pipeline, step, at))
      return *why;
    for (int64_t number = 1; number <= step.copies; ++number) {
      result.push_back(step.copies == 1 ? step : copy_of(step, number));
      if (!ids.insert(result.back().id).second)
        return *refuse(at + "/id",
                       "the pipeline has two steps '" + result.back().id + "'",
                       "give one of them another id");
    }
    if (result.size() > most_steps)
      return *refuse(at + "/copies",
                     "with it the task has more than "
                         + std::to_string(most_steps) + " steps",
                     "make fewer copies, or two tasks");
  }
  return result;
}

} // namespace roscell
