#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <optional>
#include <string>

/// How the CELL COORDINATOR begins to let a member go.
namespace roscell {

struct transfer_order {
  std::string node;
  std::string target; ///< Name of the cell; empty: independence.
  instance_policy instances = instance_policy::refuse;
  join_origin origin = join_origin::chosen;
};

/// Why a node of this cell cannot go, if so.
std::optional<failure> objection_to(coordinator_pointer self,
                                    const transfer_order& order);

/// The part of it that instances are: those of deploying tasks count.
std::optional<failure> objection_to_instances(const cell_coordinator_state& st,
                                              const transfer_order& order);

/// Lets a node of this cell go. `done` hears of the outcome, or that it cannot
/// be known in time.
void start_transfer(coordinator_pointer self, const transfer_order& order,
                    transfer_done done);

} // namespace roscell
