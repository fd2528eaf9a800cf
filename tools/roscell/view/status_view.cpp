#include "client/columns.hpp"
#include "tools/roscell/view/describe/page.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/views.hpp"

#include <algorithm>
#include <map>

namespace roscell::cli {

namespace {

/// "name          value", the values in one column.
page details_page(const view_style& style) {
  return page{style.text, "", 14};
}

/// "3 running, 1 failed"
std::string counted(const std::vector<instance_row>& instances) {
  std::map<std::string, size_t> counts;
  for (const auto& row : instances)
    ++counts[row.unknown_since_unix_ms == 0 ? to_string(row.state) : "unknown"];
  std::string result;
  for (const auto& [state, count] : counts)
    result +=
        (result.empty() ? "" : ", ") + std::to_string(count) + " " + state;
  return result.empty() ? "none" : result;
}

/// What the node has written to its database, and how much that is a day if it
/// has run for long enough to tell.
std::string disk_writes(const node_description& node, int64_t now_unix_ms) {
  constexpr double hour_ms = 3'600'000;
  if (node.stored_bytes <= 0)
    return {};
  const auto bytes = static_cast<double>(node.stored_bytes);
  const auto age_ms = static_cast<double>(now_unix_ms)
                      - static_cast<double>(node.started_unix_ms);
  if (node.started_unix_ms <= 0 || age_ms < hour_ms)
    return format_bytes(bytes) + " since the start";
  return format_bytes(bytes) + " ("
         + format_bytes(bytes * 24 * hour_ms / age_ms) + " a day)";
}

/// "192.168.1.10:11811: nothing listens there (tried 3 times, last 4 s ago)"
std::string join_line(const join_failure& x, int64_t now_unix_ms) {
  auto text = x.address.empty() ? std::string{"any cell"} : x.address;
  text += ": " + (x.problem.empty() ? "no answer yet" : x.problem);
  text += x.attempts == 1 ? " (tried once"
                          : " (tried " + std::to_string(x.attempts) + " times";
  return text + ", last " + format_since(x.tried_unix_ms, now_unix_ms)
         + " ago)";
}

} // namespace

std::string node_view(const node_description& node, const view_style& style) {
  auto details = details_page(style);
  details.detail("name", node.identity.name);
  details.detail("role", node.cell.empty() ? "" : role_text(node.role));
  details.detail("state", to_string(node.state));
  details.detail("cell", node.cell);
  details.detail("coordinator", node.coordinator);
  for (const auto& x : node.joining) {
    details.sentence("joining", join_line(x, style.now_unix_ms));
    details.sentence("remedy", x.hint);
  }
  details.detail("address", node.identity.address);
  details.detail("architecture", node.resources.architecture);
  details.detail("runtime", node.runtime);
  details.detail("limits", node.limits);
  details.detail("version", node.version);
  details.detail("up for",
                 format_since(node.started_unix_ms, style.now_unix_ms));
  details.detail("disk written", disk_writes(node, style.now_unix_ms));
  details.detail("skills", std::to_string(node.skills.size()));
  details.detail("instances", counted(node.instances));
  auto text = details.text() + "\n"
              + resources_table(node.resources).render(style.text);
  if (!node.instances.empty())
    text += "\n" + instances_view({node.instances}, style);
  if (!node.actors.empty())
    text += "\n" + actors_view(node.actors, style);
  return text;
}

std::string cell_summary(const cell_description& cell,
                         const view_style& style) {
  const auto active = std::count_if(
      cell.nodes.begin(), cell.nodes.end(),
      [](const registry_row& row) { return row.state == row_state::active; });
  auto details = details_page(style);
  details.detail("nodes", std::to_string(active) + " of "
                              + std::to_string(cell.nodes.size()) + " active");
  details.detail("tasks", std::to_string(cell.tasks.size()));
  details.detail("discovery", cell.discovery_server);
  auto text = "\n" + details.text();
  if (!cell.tasks.empty())
    text += "\n" + tasks_view({cell.tasks}, style);
  return text;
}

} // namespace roscell::cli
