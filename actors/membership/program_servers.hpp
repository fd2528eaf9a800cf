#pragma once

#include "actors/membership/discovery.hpp"

/// What the discovery actor does with discovery servers: its node's own one,
/// and what that knows of others.
namespace roscell {

using discovery_self = discovery_actor::stateful_pointer<discovery_state>;

/// Errors: see `discovery_actor`.
caf::result<programs_served>
serve_programs_of_node(discovery_self self, const serve_programs& request);

/// Does nothing where no server runs.
void follow_another_server(discovery_self self, const follow_server& request);

} // namespace roscell
