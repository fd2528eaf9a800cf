#include "actors/instances/life/instance_environment.hpp"

#include "actors/instances/life/health_table.hpp"
#include "actors/instances/limits.hpp"
#include "messages/codec/json_codec.hpp"

namespace roscell {

namespace {

/// Endpoints come from checked JSON, but a text that is none must not throw.
std::string text_of(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

} // namespace

std::map<std::string, std::string>
instance_environment(const instance_spec& spec,
                     const deployment_option& deployment,
                     const std::map<std::string, std::string>& of_node) {
  using std::chrono::microseconds;
  auto result = of_node;
  result.insert(spec.environment.begin(), spec.environment.end());
  result.insert(deployment.environment.begin(), deployment.environment.end());
  const std::map<std::string, std::string> contract{
      {"ROSCELL_TASK", spec.task},
      {"ROSCELL_STEP", spec.step},
      {"ROSCELL_INSTANCE", spec.instance},
      {"ROSCELL_OPERATION", spec.operation},
      {"ROSCELL_MODEL", spec.model},
      {"ROSCELL_DEPLOYMENT", spec.deployment},
      {"ROSCELL_CELL", spec.cell},
      {"ROSCELL_INPUTS", text_of(spec.input)},
      {"ROSCELL_OUTPUTS", text_of(spec.output)},
      {"ROSCELL_PARAMETERS", spec.parameters.empty() ? "{}" : spec.parameters},
      {"WATCHDOG_USEC",
       std::to_string(
           microseconds{limits::instance::announced_watchdog}.count())},
  };
  for (const auto& [name, value] : contract)
    result[name] = value;
  // To measure costs a skill some wake-ups.
  if (has_bounds(spec.life.health))
    result["ROSCELL_HEALTH"] = "1";
  if (spec.gpu >= 0) {
    // Inside the instance CUDA counts from 0, so both are needed.
    result["ROSCELL_GPU"] = std::to_string(spec.gpu);
    result["CUDA_VISIBLE_DEVICES"] = std::to_string(spec.gpu);
  }
  return result;
}

} // namespace roscell
