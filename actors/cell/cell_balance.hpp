#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <string>
#include <vector>

/// How the CELL COORDINATORS even their cells out after one has appeared or
/// died, or a place was not taken.
namespace roscell {

/// A cell as the plan sees it.
struct cell_size {
  std::string uuid;
  std::string cell;
  int64_t size = 0;
};

/// So many members of one cell are to go to another one.
struct cell_move {
  std::string from; ///< UUIDs.
  std::string to;
  int64_t count = 0;
};

/// The fewest moves after which sizes differ by at most one. The largest cells
/// keep the remainder, so nobody moves without need.
std::vector<cell_move> plan_moves(std::vector<cell_size> cells);

/// Evens out if it is time and this coordinator's part.
void balance_if_due(coordinator_pointer self);

caf::result<members_surrendered>
hand_over_members(coordinator_pointer self, const member_surrender& request);

} // namespace roscell
