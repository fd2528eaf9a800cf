#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// How what is placed on a node stays with it under another name: the CELL
/// COORDINATOR knows nodes by their UUIDs, and its tasks know them by name.
namespace roscell {

/// A node of the cell has another name from now on. It keeps what it runs.
void rename_node(coordinator_pointer self, const std::string& from,
                 const std::string& to);

/// What is placed on a name that no node of the cell has, and is on the
/// coordination node, was started when that had the name.
void follow_own_name(coordinator_pointer self, const node_registration& own);

} // namespace roscell
