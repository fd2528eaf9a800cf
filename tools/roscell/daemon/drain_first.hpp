#pragma once

#include "actors/node/spawn_node.hpp"

#include <caf/actor_system.hpp>

#include <functional>
#include <string>

namespace roscell::cli {

/// Has the coordinator move every instance away from this node, and calls
/// `done` once none is left, or it cannot be done, with the reason. Called in
/// an actor, at most once.
void drain_first(caf::actor_system& system, const running_node& node,
                 std::function<void(const std::string& problem)> done);

/// The node takes instances again, when it is back. Blocks until the
/// coordinator knows, for some seconds at most.
void undrain(caf::actor_system& system, const running_node& node);

} // namespace roscell::cli
