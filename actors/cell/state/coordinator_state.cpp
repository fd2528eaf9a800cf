#include "actors/cell/state/coordinator_state.hpp"

#include "actors/house/wall_clock.hpp"

namespace roscell {

registry_time now_of(coordinator_pointer self) {
  return {self->clock().now(), unix_now_ms()};
}

cell_address own_address(const coordinator_setup& setup) {
  return {setup.cell, setup.self.name, setup.self.address,
          setup.discovery_server};
}

} // namespace roscell
