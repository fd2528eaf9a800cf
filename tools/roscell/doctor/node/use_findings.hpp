#pragma once

#include "messages/node.hpp"
#include "tools/roscell/doctor/finding.hpp"

namespace roscell::cli {

/// Nothing, if an instance takes no more of its host than it has asked for.
findings judge_use(const instance_row& row);

/// Whether anything holds the instances of a node to that.
findings judge_limits(const node_description& node);

} // namespace roscell::cli
