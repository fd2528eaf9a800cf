#pragma once

#include "messages/cell.hpp"
#include "messages/event.hpp"
#include "tools/roscell/client/node_client.hpp"

#include <string>
#include <vector>

namespace roscell::cli {

/// All that a node tells of its cell; one in no cell, or that is no
/// coordinator, tells of itself only.
struct known_cell {
  node_description asked; ///< The node that was asked.
  cell_description cell;
  std::vector<instance_row> instances; ///< With their metrics.
  skill_list skills;
  std::vector<event> events; ///< The oldest first.
};

/// The cell as a node sees it that only knows itself.
cell_description cell_around(const node_description& node);

known_cell ask_for_cell(const node_client& node);

/// Adds what the coordinator knows of its cell to what a member has said. False
/// if there is no more to know: the node is the coordinator itself, or is in no
/// cell.
bool add_cell_of_member(const node_client& node, known_cell& known);

/// The instances of all tasks of the cell, as its coordinator knows them; none
/// if it cannot be asked.
std::vector<instance_row> instances_in_cell(const node_client& node);

/// What can be described.
enum class thing_kind { node, task, instance, skill, cell };

constexpr auto enum_words(thing_kind) {
  return std::array<std::string_view, 5>{"node", "task", "instance", "skill",
                                         "cell"};
}

struct known_thing {
  thing_kind kind = thing_kind::node;
  std::string name;
};

/// Everything that has a name.
std::vector<known_thing> things_of(const known_cell& known);

/// The thing of that name, or the only instance whose id begins so. Throws
/// command_error that says what was probably meant, or which kinds have the
/// name.
/// @param kind the word of a kind; empty: any.
known_thing find_thing(const known_cell& known, const std::string& kind,
                       const std::string& name);

} // namespace roscell::cli
