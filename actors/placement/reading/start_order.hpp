#pragma once

#include "messages/instance.hpp"

#include <cstddef>
#include <vector>

namespace roscell {

/// For each of these instances the ones that must run before it starts: those
/// that write a file which it reads, because a file that is not there is an
/// error. Nobody waits for itself in the end: where instances read each other's
/// files, those that come first in the list do not wait.
std::vector<std::vector<std::size_t>>
start_order(const std::vector<instance_spec>& specs);

} // namespace roscell
