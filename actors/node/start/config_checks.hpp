#pragma once

#include "roscell/node_config.hpp"

#include <caf/error.hpp>

namespace roscell {

/// Checks the options of a node and fills in what was left out: its name, cell
/// and address.
///
/// Errors: schema_violation (an option, named), unreachable (the address is not
/// of this host).
caf::error complete_config(node_config& config);

} // namespace roscell
