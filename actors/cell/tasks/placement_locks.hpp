#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <cstdint>
#include <functional>
#include <vector>

/// The placement lock, and the resources that a placement may count on.
/// Whatever is placed takes the lock and holds it until what was placed is
/// reserved, so that two never count on the same resources. Who holds it and
/// who waits is in `st.pending`; it is granted in the order of the requests.
namespace roscell {

/// Calls `begin` with the number of the lock when it is granted: at once when
/// nobody has it.
void take_placement_lock(coordinator_pointer self, const caf::actor_addr& owner,
                         const std::function<void(uint64_t)>& begin);

void release_placement_lock(coordinator_pointer self, uint64_t number);

/// An owner that is gone waits no more.
void leave_line(coordinator_pointer self, const caf::actor_addr& owner);

// The resources of the cell, as its nodes report them.

/// Asks every active node for its resources, and takes off what is held for
/// instances that the nodes do not know of yet. A node that does not answer in
/// time is left out.
void collect_resources_of_cell(
    coordinator_pointer self,
    const std::function<void(cell_resources&&)>& done);

/// What the steps write that are deployed and have not ended.
std::vector<deployed_end> written_in(const cell_coordinator_state& st);

caf::result<cell_resources> answer_resources(coordinator_pointer self);

} // namespace roscell
