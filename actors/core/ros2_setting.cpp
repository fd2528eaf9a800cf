#include "actors/core/ros2_setting.hpp"

namespace roscell {

void let_ros2_set_parameters(instance_spec& spec, bool allowed) {
  if (allowed)
    spec.environment[ros2_setting_variable] = "1";
  else
    spec.environment.erase(ros2_setting_variable);
}

bool lets_ros2_set_parameters(const instance_spec& spec) {
  const auto found = spec.environment.find(ros2_setting_variable);
  return found != spec.environment.end() && found->second == "1";
}

} // namespace roscell
