#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <functional>

namespace roscell {

/// Asks over its session whether the node of a member is there, for a second.
/// A node whose address has changed cannot answer where it was, nor close what
/// it had there; a lease would take it for alive eight seconds longer.
void prove_member(coordinator_pointer self, const member_actor& member,
                  const std::function<void(bool is_there)>& then);

} // namespace roscell
