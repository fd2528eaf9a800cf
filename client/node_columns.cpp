#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "client/value_text.hpp"

#include <algorithm>

namespace roscell {

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
column_value amount_value(const amount& a, double reserved, bool is_memory) {
  if (a.capacity <= 0)
    return {};
  column_value result{is_memory ? format_memory(a.used, a.capacity)
                                : format_number(a.used) + "/"
                                      + format_number(a.capacity)};
  result.usage =
      usage_share{std::max(0.0, a.used - reserved), reserved, a.capacity};
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

} // namespace

std::string role_text(node_role role) {
  return role == node_role::coordinator ? "coordinator" : "member";
}

const column_list<registry_row>& node_columns() {
  using row = const registry_row&;
  using now = int64_t;
  static const column_list<registry_row> result{
      {{"NODE"},
       [](row x, now) -> column_value { return x.identity.name; },
       "key",
       "/identity/name"},
      {{"ROLE", align::left, 4, true},
       [](row x, now) -> column_value { return role_text(x.role); }},
      {{"STATE"},
       [](row x, now) -> column_value { return state_of(x); },
       "node_state"},
      {{"SINCE", align::right, 3},
       [](row x, now y) -> column_value {
         return format_since(x.since_unix_ms, y);
       }},
      {{"ADDRESS", align::left, 5, true},
       [](row x, now) -> column_value { return x.identity.address; }},
      {{"ARCH", align::left, 7},
       [](row x, now) -> column_value { return x.resources.architecture; }},
      {{"CPU", align::right, 1},
       [](row x, now) -> column_value {
         return amount_value(x.resources.cpu, reserved_on(x).cpu, false);
       },
       "usage",
       "/resources/cpu"},
      {{"MEMORY", align::right, 1},
       [](row x, now) -> column_value {
         return amount_value(x.resources.memory_mib, reserved_on(x).memory_mib,
                             true);
       },
       "usage",
       "/resources/memory_mib"},
      {{"DISK", align::right, 6},
       [](row x, now) -> column_value {
         return amount_value(x.resources.disk_mib, reserved_on(x).disk_mib,
                             true);
       },
       "usage",
       "/resources/disk_mib"},
      {{"GPUS", align::right, 4},
       [](row x, now) -> column_value {
         return std::to_string(x.resources.gpus.size());
       }},
      {{"GPU MEMORY", align::right, 5, false, true},
       [](row x, now) -> column_value { return gpu_memory(x.resources); },
       "gpus",
       "/resources/gpus"},
      {{"INSTANCES", align::right, 3},
       [](row x, now) -> column_value { return known_count(x.instances); },
       "amount",
       "/instances"},
      {{"REASON", align::left, 2},
       [](row x, now) -> column_value { return reason_of(x); }},
      {{"LABELS", align::left, only_wide},
       [](row x, now) -> column_value { return listed(x.resources.labels); },
       "labels",
       "/resources/labels"},
      {{"DEVICES", align::left, only_wide},
       [](row x, now) -> column_value { return joined(x.resources.devices); }},
  };
  return result;
}

} // namespace roscell
