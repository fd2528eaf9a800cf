#pragma once

#include "messages/cell.hpp"
#include "messages/event.hpp"
#include "messages/skill.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace roscell {

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

/// What is wrong in a cell, a sentence each, what matters most first: nodes
/// that are away, tasks that do not run, and instances with their reasons.
std::vector<std::string> problems_of(const known_cell& known,
                                     int64_t now_unix_ms);

} // namespace roscell
