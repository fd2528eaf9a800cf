#pragma once

#include "messages/instance.hpp"
#include "messages/node.hpp"
#include "tools/roscell/doctor/check.hpp"

/// Whether instances do as they should, and take what they have asked for.
namespace roscell::cli {

/// Nothing, if an instance takes no more of its host than it has asked for.
findings judge_use(const instance_row& row);

/// Whether anything holds the instances of a node to that.
findings judge_limits(const node_description& node);

/// What is wrong with each, or that nothing is.
findings judge_instances(const std::vector<instance_row>& rows);

} // namespace roscell::cli
