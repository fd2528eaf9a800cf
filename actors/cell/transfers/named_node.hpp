#pragma once

#include "actors/cell/state/coordinator_state.hpp"

#include <string>

/// Which node an operator means by a name: names are unique in a cell only.
namespace roscell {

/// Where a node is that was named to this coordinator.
struct named_node {
  peer_actor holder;  ///< Invalid: no other cell that is known has it.
  member_claim claim; ///< Of the holder.
  std::string cell;   ///< The same.
  failure why;        ///< If it cannot be told; else without a message.
};

/// The one node of that name that other cells have.
named_node find_elsewhere(const cell_coordinator_state& st,
                          const std::string& node);

/// Names are the asked cell's first. A node of another cell is meant if that
/// cell is named too, or if it is the only one of the name and this cell has
/// let none of it go.
/// @param cell the cell that the node is in; empty: not named.
named_node find_named_node(const cell_coordinator_state& st,
                           const std::string& node, const std::string& cell);

} // namespace roscell
