#include "tools/roscell/view/views.hpp"

#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli {

namespace {

/// Nothing is shown of what has not been measured yet.
std::string cores(const amount& a) {
  if (a.capacity == 0)
    return "";
  return format_number(a.used) + "/" + format_number(a.capacity);
}

std::string memory(const amount& a) {
  return a.capacity == 0 ? "" : format_memory(a.used, a.capacity);
}

/// How many there are, and of how many nobody knows what has become of them.
std::string known_count(const std::vector<instance_row>& rows) {
  const auto unknown = std::count_if(rows.begin(), rows.end(), is_unknown);
  return std::to_string(rows.size())
         + (unknown == 0 ? "" : " (" + std::to_string(unknown) + " unknown)");
}

std::string state_of(const registry_row& row) {
  return row.draining_since_unix_ms > 0 ? to_string(row.state) + ", draining"
                                        : to_string(row.state);
}

/// Why a node is not active, and what waits for it.
std::string reason_of(const registry_row& row) {
  std::vector<std::string> words;
  if (!row.reason.empty())
    words.push_back(row.reason);
  for (const auto& x : row.instances)
    if (is_unknown(x) && !x.waits.empty())
      words.push_back(x.spec.task + "/" + x.spec.step + " " + x.waits);
  return joined(words, "; ");
}

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
std::vector<std::string> unassigned_row(const unassigned_node& node,
                                        const view_style& style) {
  std::vector<std::string> words;
  if (node.silent_since_unix_ms != 0)
    words.push_back("missed "
                    + format_since(node.silent_since_unix_ms, style.now_unix_ms)
                    + " ago");
  if (!node.cell.empty())
    words.push_back("it was in cell '" + node.cell + "'");
  const bool silent = node.silent_since_unix_ms != 0;
  return {node.name,
          "",
          silent ? "silent" : to_string(node.state),
          format_since(node.silent_since_unix_ms, style.now_unix_ms),
          node.address,
          "",
          "",
          "",
          "",
          "",
          "",
          joined(words, "; ")};
}

} // namespace

std::string role_text(node_role role) {
  return role == node_role::coordinator ? "coordinator" : "member";
}

std::string cells_view(const cell_list& cells, const view_style& style) {
  table t{{{"CELL"},
           {"COORDINATOR"},
           {"NODES", align::right},
           {"ADDRESS", align::left, 2, true},
           {"DISCOVERY SERVER", align::left, 4, true},
           {"ROS_DISCOVERY_SERVER", align::left, 3, true},
           {"ROS_DOMAIN_ID", align::right, 3}},
          {}};
  bool has_problem = false;
  for (const auto& row : cells.cells) {
    const auto problem = problem_of_cell(row, cells);
    has_problem = has_problem || !problem.empty();
    // A coordinator counts itself, so nobody has told a size of 0.
    t.rows.push_back({row.cell, row.coordinator,
                      row.size == 0 ? "" : std::to_string(row.size),
                      row.address, row.discovery_server,
                      variable_of(row, "ROS_DISCOVERY_SERVER"),
                      variable_of(row, "ROS_DOMAIN_ID"), problem});
  }
  // The cells of a row are cut to the number of columns.
  if (has_problem)
    t.columns.push_back({"TROUBLE", align::left, 1});
  return or_nothing(t, "cells", style);
}

std::string members_view(const cell_description& cell,
                         const view_style& style) {
  table t{{{"NODE"},
           {"ROLE", align::left, 4, true},
           {"STATE"},
           {"SINCE", align::right, 3},
           {"ADDRESS", align::left, 5, true},
           {"ARCH", align::left, 7},
           {"CPU", align::right, 1},
           {"MEMORY", align::right, 1},
           {"DISK", align::right, 6},
           {"GPUS", align::right, 4},
           {"INSTANCES", align::right, 3},
           {"REASON", align::left, 2},
           {"LABELS", align::left, only_wide},
           {"DEVICES", align::left, only_wide}},
          {}};
  for (const auto& row : cell.nodes) {
    const auto& r = row.resources;
    t.rows.push_back({row.identity.name, role_text(row.role), state_of(row),
                      format_since(row.since_unix_ms, style.now_unix_ms),
                      row.identity.address, r.architecture, cores(r.cpu),
                      memory(r.memory_mib), memory(r.disk_mib),
                      std::to_string(r.gpus.size()), known_count(row.instances),
                      reason_of(row), listed(r.labels), joined(r.devices)});
  }
  for (const auto& node : cell.free)
    t.rows.push_back(unassigned_row(node, style));
  return or_nothing(t, "nodes", style);
}

} // namespace roscell::cli
