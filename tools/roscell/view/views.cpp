#include "tools/roscell/view/views.hpp"

#include "client/columns.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

/// What is wrong with a cell, as its coordinator or the others tell.
std::string problem_of_cell(const cell_row& row, const cell_list& cells) {
  const auto claims = std::count_if(
      cells.cells.begin(), cells.cells.end(),
      [&](const cell_row& other) { return other.cell == row.cell; });
  if (!row.problem.empty() || claims < 2)
    return row.problem;
  return std::to_string(claims) + " coordinators claim this name";
}

std::string variable_of(const cell_row& row, const char* name) {
  const auto i = row.environment.find(name);
  return i == row.environment.end() ? "" : i->second;
}

/// A node that is in no cell has no row, so little is known of it.
registry_row unassigned_row(const unassigned_node& node,
                            const view_style& style) {
  std::vector<std::string> words;
  if (node.silent_since_unix_ms != 0)
    words.push_back("missed "
                    + format_since(node.silent_since_unix_ms, style.now_unix_ms)
                    + " ago");
  if (!node.cell.empty())
    words.push_back("it was in cell '" + node.cell + "'");
  registry_row result;
  result.identity = {node.name, node.uuid, 0, node.address};
  result.since_unix_ms = node.silent_since_unix_ms;
  result.reason = joined(words, "; ");
  return result;
}

} // namespace

std::string or_nothing(const table& t, const char* what,
                       const view_style& style) {
  return t.rows.empty() ? std::string{"no "} + what + "\n"
                        : t.render(style.text);
}

std::string cells_view(const cell_list& cells, const view_style& style) {
  table t{{{"CELL"},
           {"COORDINATOR"},
           {"NODES", align::right},
           {"ADDRESS", align::left, 2, true},
           {"DISCOVERY SERVER", align::left, 4, true},
           {"ROS_DISCOVERY_SERVER", align::left, 3, true},
           {"ROS_DOMAIN_ID", align::right, 3},
           {"TROUBLE", align::left, 1, false, true}},
          {}};
  for (const auto& row : cells.cells)
    // A coordinator counts itself, so nobody has told a size of 0.
    t.rows.push_back(
        {row.cell, row.coordinator,
         row.size == 0 ? "" : std::to_string(row.size), row.address,
         row.discovery_server, variable_of(row, "ROS_DISCOVERY_SERVER"),
         variable_of(row, "ROS_DOMAIN_ID"), problem_of_cell(row, cells)});
  return or_nothing(t, "cells", style);
}

table nodes_table(const cell_description& cell, const view_style& style) {
  auto result = table_of(node_columns(), cell.nodes, style);
  const auto put = [&](std::vector<column_value>& to, const char* name,
                       const std::string& text) {
    to.at(*column_of(result, name)) = text;
  };
  for (const auto& node : cell.free) {
    auto rows = table_of(node_columns(), {unassigned_row(node, style)}, style);
    auto& to = result.rows.emplace_back(std::move(rows.rows.front()));
    put(to, "STATE",
        node.silent_since_unix_ms != 0 ? "silent" : to_string(node.state));
    for (const auto* unknown : {"ROLE", "GPUS", "INSTANCES"})
      put(to, unknown, "");
  }
  return result;
}

std::string members_view(const cell_description& cell,
                         const view_style& style) {
  return or_nothing(nodes_table(cell, style), "nodes", style);
}

} // namespace roscell::cli
