#include "actors/cell/sets/set_template.hpp"

#include "actors/placement/reading/step_copies.hpp"
#include "actors/placement/reading/task_reading.hpp"
#include "schemas/reading/placeholder.hpp"

#include <utility>

namespace roscell {

namespace {

/// As schemas/common.schema.json has it.
constexpr size_t longest_name = 63;

task_step step_for(const task_step& step, const std::string& node) {
  json document = step;
  fill_placeholder(document, "node", node);
  auto result = document.get<task_step>();
  if (!result.anywhere)
    result.labels["node"] = node;
  result.anywhere = false;
  return result;
}

} // namespace

std::string body_of(task_set_request request) {
  request.dry_run = request.run_again = request.only_new = request.force =
      false;
  return message_json(request).dump();
}

std::string task_name(const std::string& set, const std::string& node) {
  return set + "-" + node;
}

std::variant<task_request, failure> task_for(const task_set_request& set,
                                             const std::string& node) {
  task_request result;
  result.task = task_name(set.task, node);
  if (result.task.size() > longest_name)
    return failure{error_code::schema_violation,
                   "'" + result.task + "' is longer than "
                       + std::to_string(longest_name) + " characters",
                   "/task", "give the set or the node a shorter name"};
  for (const auto& step : set.pipeline)
    result.pipeline.push_back(step_for(step, node));
  auto copies = with_copies(result.pipeline);
  if (auto* why = std::get_if<failure>(&copies))
    return std::move(*why);
  result.pipeline = std::get<std::vector<task_step>>(std::move(copies));
  result.timeout_s = set.timeout_s;
  result.labels = set.labels;
  result.update = set.update;
  result.set = set.task;
  return result;
}

std::shared_ptr<const node_task> node_tasks::of(const task_set_request& set,
                                                const std::string& node) {
  auto& known = known_[node];
  if (known)
    return known;
  node_task fresh;
  auto request = task_for(set, node);
  if (auto* why = std::get_if<failure>(&request)) {
    fresh.problem = why->message;
  } else {
    fresh.request = std::get<task_request>(std::move(request));
    fresh.body = body_of(fresh.request);
  }
  known = std::make_shared<const node_task>(std::move(fresh));
  return known;
}

void node_tasks::keep_within(size_t most) {
  if (known_.size() > most)
    known_.clear();
}

} // namespace roscell
