#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>
#include <vector>

namespace roscell {

/// Tells all other coordinators that rows have changed or are gone.
void publish(coordinator_pointer self,
             const std::vector<std::string>& changed_uuids,
             const std::vector<std::string>& gone_uuids = {});

/// Forgets a node: its row, its record, and what others have heard of it.
void drop_row(coordinator_pointer self, const std::string& uuid);

} // namespace roscell
