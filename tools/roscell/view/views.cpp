#include "tools/roscell/view/columns.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/instance_text.hpp"

#include <algorithm>
#include <set>

namespace roscell::cli {

namespace {

/// What the live instances of a node have reserved, of each resource.
resource_request reserved_on(const registry_row& row) {
  resource_request result;
  for (const auto& x : row.instances) {
    if (!is_live(x.state))
      continue;
    result.cpu += x.spec.resources.cpu;
    result.memory_mib += x.spec.resources.memory_mib;
    result.disk_mib += x.spec.resources.disk_mib;
  }
  return result;
}

/// Nothing is shown of what has not been measured yet. A node counts what is
/// reserved among what is used.
cell amount_cell(const amount& a, double reserved, bool is_memory) {
  if (a.capacity <= 0)
    return {};
  cell result{is_memory
                  ? format_memory(a.used, a.capacity)
                  : format_number(a.used) + "/" + format_number(a.capacity)};
  result.usage = share{std::max(0.0, a.used - reserved), reserved, a.capacity};
  return result;
}

/// That of each GPU; one that shares the node's memory has none of its own.
std::string gpu_memory(const node_resources& r) {
  std::vector<std::string> words;
  for (const auto& gpu : r.gpus)
    words.push_back(
        r.unified_memory || gpu.memory_mib.capacity <= 0
            ? "shared"
            : format_memory(gpu.memory_mib.used, gpu.memory_mib.capacity));
  return joined(words, ", ");
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

const column_list<registry_row>& node_columns() {
  using row = const registry_row&;
  using how = const view_style&;
  static const column_list<registry_row> result{
      {{"NODE"},
       [](row x, how) -> cell { return x.identity.name; },
       "key",
       "/identity/name"},
      {{"ROLE", align::left, 4, true},
       [](row x, how) -> cell { return role_text(x.role); }},
      {{"STATE"}, [](row x, how) -> cell { return state_of(x); }, "node_state"},
      {{"SINCE", align::right, 3},
       [](row x, how y) -> cell {
         return format_since(x.since_unix_ms, y.now_unix_ms);
       }},
      {{"ADDRESS", align::left, 5, true},
       [](row x, how) -> cell { return x.identity.address; }},
      {{"ARCH", align::left, 7},
       [](row x, how) -> cell { return x.resources.architecture; }},
      {{"CPU", align::right, 1},
       [](row x, how) -> cell {
         return amount_cell(x.resources.cpu, reserved_on(x).cpu, false);
       },
       "usage",
       "/resources/cpu"},
      {{"MEMORY", align::right, 1},
       [](row x, how) -> cell {
         return amount_cell(x.resources.memory_mib, reserved_on(x).memory_mib,
                            true);
       },
       "usage",
       "/resources/memory_mib"},
      {{"DISK", align::right, 6},
       [](row x, how) -> cell {
         return amount_cell(x.resources.disk_mib, reserved_on(x).disk_mib,
                            true);
       },
       "usage",
       "/resources/disk_mib"},
      {{"GPUS", align::right, 4},
       [](row x, how) -> cell {
         return std::to_string(x.resources.gpus.size());
       }},
      {{"GPU MEMORY", align::right, 5, false, true},
       [](row x, how) -> cell { return gpu_memory(x.resources); },
       "gpus",
       "/resources/gpus"},
      {{"INSTANCES", align::right, 3},
       [](row x, how) -> cell { return known_count(x.instances); },
       "amount",
       "/instances"},
      {{"REASON", align::left, 2},
       [](row x, how) -> cell { return reason_of(x); }},
      {{"LABELS", align::left, only_wide},
       [](row x, how) -> cell { return listed(x.resources.labels); },
       "labels",
       "/resources/labels"},
      {{"DEVICES", align::left, only_wide},
       [](row x, how) -> cell { return joined(x.resources.devices); }},
  };
  return result;
}

table nodes_table(const cell_description& cell, const view_style& style) {
  auto result = table_of(node_columns(), cell.nodes, style);
  const auto put = [&](std::vector<struct cell>& to, const char* name,
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
