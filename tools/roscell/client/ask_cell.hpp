#pragma once

#include "client/known_cell.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <vector>

namespace roscell::cli {

known_cell ask_for_cell(const node_client& node);

/// Adds what the coordinator knows of its cell to what a member has said. False
/// if there is no more to know: the node is the coordinator itself, or is in no
/// cell.
bool add_cell_of_member(const node_client& node, known_cell& known);

/// The instances of all tasks of the cell, as its coordinator knows them; none
/// if it cannot be asked.
std::vector<instance_row> instances_in_cell(const node_client& node);

} // namespace roscell::cli
