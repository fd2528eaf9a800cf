#pragma once

#include "actors/edge/io_thread.hpp"
#include "actors/house.hpp"
#include "actors/node_config.hpp"
#include "messages/type_ids.hpp"

#include <caf/error.hpp>

#include <functional>

namespace roscell {

/// Whether the runtime that was asked for can be had, and its shim.
/// Errors: schema_violation (an unknown runtime, or one that is not built in),
/// engine_failed (the shim is missing).
caf::error check_runtime(node_config& config);

/// Spawns the runtime that the configuration names.
std::function<runtime_actor(container_listener_actor)>
runtime_factory(caf::actor_system& system, const house& context,
                const node_config& config, const io_thread& io);

} // namespace roscell
