#pragma once

#include "messages/session.hpp"

#include <vector>

namespace roscell {

/// Takes the starts out of an answer to a registration for which one frame has
/// no room: parameters may be long. They follow it as requests of their own.
std::vector<instance_spec> take_long_starts(node_registered& answer);

} // namespace roscell
