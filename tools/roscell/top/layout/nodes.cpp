#include "tools/roscell/top/layout/things.hpp"

#include "tools/roscell/view/format.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace roscell::cli::top {

namespace {

/// What the live instances of a node have reserved.
struct reservations {
  resource_request host;
  std::map<int, double> gpu_memory_mib; ///< By index.
  size_t instances = 0;
};

std::map<std::string, reservations>
reservations_in(const std::vector<instance_row>& rows) {
  std::map<std::string, reservations> result;
  for (const auto& row : rows) {
    if (!is_live(row.state))
      continue;
    auto& to = result[row.node];
    const auto& wanted = row.spec.resources;
    to.host.cpu += wanted.cpu;
    to.host.memory_mib += wanted.memory_mib;
    to.host.disk_mib += wanted.disk_mib;
    if (wanted.needs_gpu())
      to.gpu_memory_mib[row.spec.gpu] += wanted.gpu_memory_mib;
    ++to.instances;
  }
  return result;
}

std::string percent(const share& x) {
  const auto value = format_number(std::min(x.part(), 9.99) * 100, 0) + "%";
  return std::string(4 - std::min<size_t>(4, value.size()), ' ') + value;
}

/// A node counts what is reserved among what is used.
cell usage_cell(const amount& a, double reserved, bool is_memory) {
  if (a.capacity <= 0)
    return {};
  const share x{std::max(0.0, a.used - reserved), reserved, a.capacity};
  cell result;
  result.text = percent(x);
  result.how = x.part() >= 0.9 ? look::bad : look::plain;
  result.usage = x;
  result.more = is_memory
                    ? format_memory(x.used(), a.capacity)
                    : format_number(x.used()) + "/" + format_number(a.capacity);
  return result;
}

std::string state_text_of(const registry_row& row) {
  return row.draining_since_unix_ms > 0 ? to_string(row.state) + ", draining"
                                        : to_string(row.state);
}

std::vector<std::vector<cell>> gpu_lines(const node_resources& r,
                                         const reservations& held) {
  std::vector<std::vector<cell>> result;
  for (const auto& gpu : r.gpus) {
    const auto found = held.gpu_memory_mib.find(gpu.index);
    const auto reserved =
        found == held.gpu_memory_mib.end() ? 0 : found->second;
    auto& to = result.emplace_back();
    to.push_back({"gpu " + std::to_string(gpu.index)});
    to.push_back(r.unified_memory
                     ? cell{"shares the node's memory", look::faint}
                     : usage_cell(gpu.memory_mib, reserved, true));
    to.push_back({gpu.name, look::faint});
  }
  return result;
}

item member_item(const registry_row& row, const reservations& held,
                 int64_t now_unix_ms) {
  const auto& r = row.resources;
  const auto state = state_text_of(row);
  item result;
  result.id = row.identity.name;
  result.cells = {{row.identity.name},
                  {state, look_of_state(state)},
                  usage_cell(r.cpu, held.host.cpu, false),
                  usage_cell(r.memory_mib, held.host.memory_mib, true),
                  usage_cell(r.disk_mib, held.host.disk_mib, true),
                  {std::to_string(held.instances)},
                  {format_since(row.since_unix_ms, now_unix_ms)},
                  {row.reason},
                  {row.identity.address}};
  result.below = gpu_lines(r, held);
  return result;
}

/// Of a node that is in no cell little is known.
item unassigned_item(const unassigned_node& node, int64_t now_unix_ms) {
  const bool silent = node.silent_since_unix_ms != 0;
  const auto state = silent ? "silent" : to_string(node.state);
  item result;
  result.id = node.name;
  result.cells = {
      {node.name},
      {state, look_of_state(state)},
      {},
      {},
      {},
      {},
      {format_since(node.silent_since_unix_ms, now_unix_ms)},
      {node.cell.empty() ? "in no cell" : "it was in cell " + node.cell},
      {node.address}};
  return result;
}

} // namespace

listing list_nodes(const known_cell& known, int64_t now_unix_ms) {
  listing result;
  result.columns = {{"NODE"},
                    {"STATE"},
                    {"CPU", align::left, 1},
                    {"MEMORY", align::left, 2},
                    {"DISK", align::left, 4},
                    {"INSTANCES", align::right, 5},
                    {"SINCE", align::right, 3},
                    {"REASON", align::left, 6},
                    {"ADDRESS", align::left, 7, true}};
  const auto held = reservations_in(known.instances);
  const reservations none;
  for (const auto& row : known.cell.nodes) {
    const auto found = held.find(row.identity.name);
    result.items.push_back(member_item(
        row, found == held.end() ? none : found->second, now_unix_ms));
  }
  for (const auto& node : known.cell.free)
    result.items.push_back(unassigned_item(node, now_unix_ms));
  return result;
}

} // namespace roscell::cli::top
