#include "tools/roscell/view/views.hpp"

#include "tools/roscell/view/format.hpp"

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

std::string or_nothing(const table& t, const char* what,
                       const view_style& style) {
  return t.rows.empty() ? std::string{"no "} + what + "\n"
                        : t.render(style.text);
}

/// What stands behind an instance's state: why it is not known at present, why
/// it ended, or what it says.
std::string remark(const instance_row& row) {
  if (row.unknown_since_unix_ms != 0)
    return "its node is away; it was " + to_string(row.state);
  if (!row.reason.empty())
    return row.reason;
  if (!row.trouble.empty())
    return row.trouble;
  // The columns say it better.
  return row.figures == instance_figures{} ? row.status : "";
}

std::string figure(double value, int decimals, const char* unit) {
  return value < 0 ? "" : format_number(value, decimals) + unit;
}

std::string count_text(int64_t count) {
  return count < 0 ? "" : std::to_string(count);
}

bool is_unknown(const instance_row& row) {
  return row.unknown_since_unix_ms != 0;
}

/// What a node that is away runs is not known, whatever it ran before.
std::string state_text(const instance_row& row) {
  return is_unknown(row) ? "unknown" : to_string(row.state);
}

/// How many there are, and of how many nobody knows what has become of them.
std::string known_count(const std::vector<instance_row>& rows) {
  const auto unknown = std::count_if(rows.begin(), rows.end(), is_unknown);
  return std::to_string(rows.size())
         + (unknown == 0 ? "" : " (" + std::to_string(unknown) + " unknown)");
}

std::string since_text(const instance_row& row, const view_style& style) {
  return format_since(is_unknown(row) ? row.unknown_since_unix_ms
                                      : row.since_unix_ms,
                      style.now_unix_ms);
}

/// How many of a task's instances run, and since when some are not known.
std::string running_text(const std::vector<instance_row>& rows,
                         const view_style& style) {
  size_t running = 0;
  int64_t unknown = 0;
  int64_t since = 0;
  for (const auto& row : rows) {
    if (!is_unknown(row)) {
      running += row.state == instance_state::running ? 1 : 0;
      continue;
    }
    ++unknown;
    since = since == 0 ? row.unknown_since_unix_ms
                       : std::min(since, row.unknown_since_unix_ms);
  }
  auto result = std::to_string(running) + "/" + std::to_string(rows.size());
  if (unknown > 0)
    result += ", " + std::to_string(unknown) + " unknown since "
              + format_since(since, style.now_unix_ms);
  return result;
}

std::string exit_text(int code) {
  return code < 0 ? "" : std::to_string(code);
}

/// What is wrong with a cell, as its coordinator or the others tell.
std::string trouble_of(const cell_row& row, const cell_list& cells) {
  const auto claims = std::count_if(
      cells.cells.begin(), cells.cells.end(),
      [&](const cell_row& other) { return other.cell == row.cell; });
  if (!row.trouble.empty() || claims < 2)
    return row.trouble;
  return std::to_string(claims) + " coordinators claim this name";
}

std::string variable_of(const cell_row& row, const char* name) {
  const auto i = row.environment.find(name);
  return i == row.environment.end() ? "" : i->second;
}

/// A node that is in no cell has no row, so little is known of it.
std::vector<std::string> free_row(const free_node& node,
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
          to_string(node_role::primary),
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

std::string cells_view(const cell_list& cells, const view_style& style) {
  table t{{{"CELL"},
           {"COORDINATOR"},
           {"NODES", align::right},
           {"ADDRESS", align::left, 2, true},
           {"DISCOVERY SERVER", align::left, 4, true},
           {"ROS_DISCOVERY_SERVER", align::left, 3, true},
           {"ROS_DOMAIN_ID", align::right, 3}},
          {}};
  bool troubled = false;
  for (const auto& row : cells.cells) {
    const auto trouble = trouble_of(row, cells);
    troubled = troubled || !trouble.empty();
    // A coordinator counts itself, so nobody has told a size of 0.
    t.rows.push_back({row.cell, row.coordinator,
                      row.size == 0 ? "" : std::to_string(row.size),
                      row.address, row.discovery_server,
                      variable_of(row, "ROS_DISCOVERY_SERVER"),
                      variable_of(row, "ROS_DOMAIN_ID"), trouble});
  }
  // The cells of a row are cut to the number of columns.
  if (troubled)
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
    t.rows.push_back({row.identity.name, to_string(row.role),
                      to_string(row.state),
                      format_since(row.since_unix_ms, style.now_unix_ms),
                      row.identity.address, r.architecture, cores(r.cpu),
                      memory(r.memory_mib), memory(r.disk_mib),
                      std::to_string(r.gpus.size()), known_count(row.instances),
                      row.reason, listed(r.labels), joined(r.devices)});
  }
  for (const auto& node : cell.free)
    t.rows.push_back(free_row(node, style));
  return or_nothing(t, "nodes", style);
}

std::string tasks_view(const task_description& tasks, const view_style& style) {
  table t{{{"TASK"},
           {"STATE"},
           {"AGE", align::right, 2},
           {"RUNNING", align::right},
           {"NODES", align::left, 1}},
          {}};
  for (const auto& row : tasks.tasks) {
    std::set<std::string> nodes;
    for (const auto& i : row.instances)
      nodes.insert(i.node);
    t.rows.push_back({row.task, to_string(row.state),
                      format_since(row.submitted_unix_ms, style.now_unix_ms),
                      running_text(row.instances, style), listed(nodes)});
  }
  return or_nothing(t, "tasks", style);
}

std::string task_view(const task_description& tasks, const view_style& style) {
  table t{{{"STEP"},
           {"NODE", align::left, 3},
           {"STATE"},
           {"RATE", align::right, 1},
           {"DROPPED", align::right, 2},
           {"LATENCY", align::right, 1},
           {"DATA AGE", align::right}},
          {}};
  double oldest_ms = -1;
  for (const auto& task : tasks.tasks)
    for (const auto& row : task.instances) {
      const auto& x = row.figures;
      oldest_ms = std::max(oldest_ms, x.age_ms);
      t.rows.push_back({row.spec.step, row.node, state_text(row),
                        figure(x.rate_hz, 1, " Hz"), count_text(x.dropped),
                        figure(x.latency_ms, 2, " ms"),
                        figure(x.age_ms, 1, " ms")});
    }
  auto text = tasks_view(tasks, style);
  if (!t.rows.empty())
    text += "\n" + t.render(style.text);
  if (oldest_ms >= 0)
    text += "\nfrom a sensor's stamp to the last output: "
            + format_number(oldest_ms, 1) + " ms (median)\n";
  return text;
}

std::string instances_view(const instance_description& instances,
                           const view_style& style) {
  table t{{{"INSTANCE"},
           {"TASK", align::left, 6, true},
           {"STEP", align::left, 5, true},
           {"NODE"},
           {"STATE"},
           {"SINCE", align::right, 2},
           {"FRAMES", align::right, 4},
           {"RATE", align::right, 1},
           {"DROPPED", align::right, 3},
           {"LATENCY", align::right, 2},
           {"DATA AGE", align::right, 2},
           {"DEPLOYMENT", align::left, 7},
           {"EXIT", align::right, 3},
           {"REMARK", align::left, 4}},
          {}};
  for (const auto& row : instances.instances) {
    const auto& x = row.figures;
    t.rows.push_back({row.spec.instance, row.spec.task, row.spec.step, row.node,
                      state_text(row), since_text(row, style),
                      count_text(x.frames), figure(x.rate_hz, 1, " Hz"),
                      count_text(x.dropped), figure(x.latency_ms, 2, " ms"),
                      figure(x.age_ms, 1, " ms"),
                      row.spec.model + "/" + row.spec.deployment,
                      exit_text(row.exit_code), remark(row)});
  }
  return or_nothing(t, "instances", style);
}

} // namespace roscell::cli
