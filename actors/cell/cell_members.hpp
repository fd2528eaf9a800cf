#pragma once

#include "actors/cell/state/coordinator_state.hpp"

/// What the CELL COORDINATOR does about its members.
namespace roscell {

/// Gives the coordination node its own row.
void add_own_row(coordinator_pointer self);

/// Asks what this node offers, so that the registry shows it from the start.
void measure_own_node(coordinator_pointer self);

/// A node has opened a session and may register over it.
void on_member_admitted(coordinator_pointer self,
                        const session_admitted& event);
caf::result<node_registered> register_member(coordinator_pointer self,
                                             const register_node& request);
caf::result<node_departed> depart_member(coordinator_pointer self,
                                         const depart_node& request);
void on_member_lost(coordinator_pointer self, const member_lost& event);

/// Rows that an earlier run of the coordinator had, as `expected`.
void restore_members(coordinator_pointer self);

/// A node has other skills. What is placed from then on is placed by them; what
/// runs goes on.
void on_skills_changed(coordinator_pointer self,
                       const member_skills_changed& event);

/// The same of the coordinator's own node.
void on_own_skills_changed(coordinator_pointer self, const skills_changed& now);

/// A member has ended. One that could not say so is lost.
void on_member_down(coordinator_pointer self, const caf::actor_addr& gone);

} // namespace roscell
