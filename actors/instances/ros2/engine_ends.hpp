#pragma once

#include "messages/inside/link.hpp"
#include "messages/instance.hpp"

#include <optional>
#include <vector>

namespace roscell {

/// What the node's discovery server must know of an instance whose skill has
/// counted `frames`, which only one of our engine does: it opens all its topics
/// before it is ready, by a participant that is named for the instance. None:
/// it has no ROS 2 topics.
std::optional<watch_endpoints>
engine_ends(const instance_spec& spec, const std::vector<stream_count>& frames);

} // namespace roscell
