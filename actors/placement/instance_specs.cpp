#include "actors/placement/instance_specs.hpp"

#include "actors/placement/reading/stream_names.hpp"
#include "actors/placement/skill_resolution.hpp"
#include "messages/stream_protocols.hpp"
#include "schemas/parameters/declared_parameter.hpp"

#include <algorithm>
#include <cstdio>
#include <random>
#include <utility>

namespace roscell {

namespace {

/// Eight hex digits that no other instance of the task has had.
std::string random_suffix() {
  std::random_device source;
  char text[9];
  std::snprintf(text, sizeof(text), "%08x", static_cast<unsigned>(source()));
  return text;
}

/// The build that a step was placed with.
const skill_build& chosen_build(const resolved_step& step,
                                const step_allocation& placed) {
  return *std::find_if(step.builds.begin(), step.builds.end(),
                       [&](const auto& x) { return x.hash == placed.build; });
}

const deployment_option& chosen_option(const implementation_model& model,
                                       const std::string& name) {
  const auto& options = model.deployments;
  return *std::find_if(options.begin(), options.end(),
                       [&](const auto& x) { return x.name == name; });
}

} // namespace

std::vector<instance_spec> make_specs(const allocated_task& task) {
  std::vector<instance_spec> result;
  for (size_t i = 0; i < task.steps.size(); ++i) {
    const auto& x = task.steps[i];
    const auto& placed = task.plan.allocations[i];
    const auto& build = chosen_build(x, placed);
    const auto& option = chosen_option(build.model, placed.deployment);
    instance_spec spec;
    spec.instance = task.request.task + "-" + x.step.id + "-" + random_suffix();
    spec.task = task.request.task;
    spec.step = x.step.id;
    spec.operation = x.step.operation;
    spec.model = x.step.model;
    spec.deployment = option.name;
    spec.skill = build.hash;
    spec.gpu = placed.gpu;
    spec.input = x.step.input;
    spec.output = x.step.output;
    spec.parameters =
        step_parameters(build.model.parameters, x.step.parameters).dump();
    spec.environment = x.step.env;
    spec.environment.insert(option.environment.begin(),
                            option.environment.end());
    spec.arguments = x.step.arguments;
    spec.secrets = x.step.secrets;
    spec.secret_env = x.step.secret_env;
    spec.resources = option.resources;
    spec.life = life_of(x.step, option, build.safe_state);
    result.push_back(std::move(spec));
  }
  name_upstream_steps(result);
  return result;
}

namespace {

bool same_stream(const io_endpoint& x, const io_endpoint& y) {
  return x.protocol == y.protocol
         && (x.protocol == protocols::ros2
                 ? full_topic(x.endpoint) == full_topic(y.endpoint)
                 : x.endpoint == y.endpoint);
}

bool writes(const instance_spec& step, const io_endpoint& input) {
  return std::any_of(
      step.output.begin(), step.output.end(),
      [&](const io_endpoint& x) { return same_stream(x, input); });
}

} // namespace

void name_upstream_steps(std::vector<instance_spec>& task) {
  for (auto& reader : task)
    for (auto& input : reader.input) {
      const auto writer =
          std::find_if(task.begin(), task.end(),
                       [&](const auto& x) { return writes(x, input); });
      if (!input.external && writer != task.end())
        input.from = writer->step;
    }
}

} // namespace roscell
