#pragma once

#include "messages/instance.hpp"

#include <vector>

namespace roscell {

/// Says at each input which step of the task writes it (`io_endpoint::from`),
/// so that a node can name it when nothing comes. An input that no step of the
/// task writes, or that a program outside of it does, stays as it is.
void name_upstream_steps(std::vector<instance_spec>& task);

} // namespace roscell
