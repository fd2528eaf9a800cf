#include "actors/cell/state/coordinator_state.hpp"

#include "actors/core/clocks.hpp"
#include "actors/core/ros2_setting.hpp"

namespace roscell {

registry_time now_of(coordinator_pointer self) {
  return {self->clock().now(), unix_now_ms()};
}

void complete_spec(const cell_coordinator_state& st, instance_spec& spec) {
  spec.cell = st.setup.cell;
  // No skill may choose another cell's discovery server.
  for (const auto& [name, value] : st.setup.environment)
    spec.environment[name] = value;
  let_ros2_set_parameters(spec, st.setup.ros2_set_parameters);
}

bool is_draining(const cell_coordinator_state& st, const registry_entry& node) {
  return st.drains.find(node.row.identity.uuid) != nullptr;
}

cell_address own_address(const coordinator_setup& setup) {
  return {setup.cell, setup.self.name, setup.self.address,
          setup.discovery_server};
}

} // namespace roscell
