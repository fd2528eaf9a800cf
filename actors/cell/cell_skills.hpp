#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// How the CELL COORDINATOR hears that a node has other skills. What is placed
/// from then on is placed by them; what runs goes on.
namespace roscell {

void on_member_skills_changed(coordinator_pointer self,
                              const member_skills_changed& event);

/// Of the coordinator's own node.
void on_own_skills_changed(coordinator_pointer self, const skills_changed& now);

} // namespace roscell
