#include "tools/roscell/view/describe/describe_view.hpp"

#include "client/columns.hpp"
#include "client/instance_text.hpp"
#include "messages/event_kinds.hpp"
#include "tools/roscell/view/describe/page.hpp"
#include "tools/roscell/view/event_text.hpp"
#include "tools/roscell/view/format.hpp"
#include "tools/roscell/view/graph/task_graph.hpp"
#include "tools/roscell/view/task_replies.hpp"
#include "tools/roscell/view/views.hpp"

#include <algorithm>
#include <iterator>
#include <set>

namespace roscell::cli {

namespace {

/// Rows of which the predicate holds.
template <class Row, class Predicate>
std::vector<Row> those(const std::vector<Row>& all, Predicate&& is_meant) {
  std::vector<Row> result;
  std::copy_if(all.begin(), all.end(), std::back_inserter(result), is_meant);
  return result;
}

std::vector<instance_row> on_node(const known_cell& known,
                                  const std::string& node) {
  return those(known.instances, [&](const auto& x) { return x.node == node; });
}

std::vector<instance_row> of_task(const known_cell& known,
                                  const std::string& task) {
  return those(known.instances,
               [&](const auto& x) { return x.spec.task == task; });
}

std::string skills_on(const known_cell& known, const std::string& node) {
  std::set<std::string> names;
  for (const auto& x : known.skills.skills)
    if (std::find(x.nodes.begin(), x.nodes.end(), node) != x.nodes.end())
      names.insert(x.skill.descriptor.operation);
  return joined({names.begin(), names.end()}, ", ");
}

void describe_member(page& out, const known_cell& known,
                     const registry_row& row, const view_style& style) {
  const auto& name = row.identity.name;
  out.detail("Role", role_text(row.role));
  out.detail("State", to_string(row.state));
  out.detail("Since", time_and_age_text(row.since_unix_ms, style));
  out.detail("Reason", row.reason);
  out.detail("Cell", known.cell.cell);
  out.detail("Address", row.identity.address);
  out.detail("UUID", row.identity.uuid);
  out.detail("Epoch", std::to_string(row.identity.epoch));
  out.detail("Architecture", row.resources.architecture);
  out.detail("Labels", listed(row.resources.labels));
  out.detail("Devices", joined(row.resources.devices, ", "));
  out.detail("Grants", joined(row.resources.grants, ", "));
  out.detail("Skills", skills_on(known, name));
  out.section("Resources", resources_table(row.resources));
  out.section("Instances", instances_table(on_node(known, name), style));
}

void describe_unassigned(page& out, const unassigned_node& node,
                         const view_style& style) {
  const bool silent = node.silent_since_unix_ms != 0;
  out.detail("State", silent ? "silent" : to_string(node.state));
  out.detail("Last seen", time_and_age_text(node.silent_since_unix_ms, style));
  out.detail("Former cell", node.cell);
  out.detail("Address", node.address);
  out.detail("UUID", node.uuid);
}

/// A process has no container and no image: its runtime's id of it is "<pid of
/// its shim>:<start>", and what stands for the image the folder of its skill.
void describe_program(page& out, const instance_row& row) {
  const auto pid =
      row.metrics.use.pid > 0 ? std::to_string(row.metrics.use.pid) : "";
  if (row.image.rfind('/', 0) != 0) {
    out.detail("Process", pid);
    out.detail("Container", row.container);
    out.detail("Image", row.image);
    return;
  }
  if (!row.container.empty())
    out.detail("Process",
               (pid.empty() ? "" : pid + ", ") + "its shim is "
                   + row.container.substr(0, row.container.find(':')));
  out.detail("Folder", row.image);
}

/// How far its update is, or why the last one was put back; or nothing.
std::string update_text(const task_row& row) {
  if (!row.updating.empty())
    return "goes on, " + row.updating;
  return row.update_problem.empty()
             ? ""
             : "what was replaced was put back: " + row.update_problem;
}

/// Where the task's steps were placed, and the score of that, if the node still
/// has the event.
std::string allocation_text(const known_cell& known, const std::string& task) {
  const auto& all = known.events;
  const auto last = std::find_if(all.rbegin(), all.rend(), [&](const auto& e) {
    return e.what == events::allocation_chosen && e.subject == task;
  });
  return last == all.rend() ? "" : event_particulars(*last);
}

} // namespace

void describe_node(page& out, const known_cell& known, const std::string& name,
                   const view_style& style) {
  for (const auto& row : known.cell.nodes)
    if (row.identity.name == name)
      return describe_member(out, known, row, style);
  for (const auto& node : known.cell.free)
    if (node.name == name)
      return describe_unassigned(out, node, style);
}

void describe_task(page& out, const known_cell& known, const std::string& name,
                   const view_style& style) {
  for (const auto& row : known.cell.tasks) {
    if (row.task != name)
      continue;
    out.detail("State", to_string(row.state));
    out.detail("Submitted", time_and_age_text(row.submitted_unix_ms, style));
    out.detail("Run", std::to_string(row.run));
    out.detail("Ends at", deadline_text(row.deadline_unix_ms));
    out.detail("Revision", std::to_string(row.revision));
    out.sentence("Update", update_text(row));
    out.detail("Labels", listed(row.labels));
  }
  out.detail("Allocation", allocation_text(known, name));
  const auto steps = of_task(known, name);
  out.section("Steps", instances_table(steps, style));
  for (const auto& x : steps) {
    out.section("Step " + printable(x.spec.step) + ": "
                    + printable(x.spec.operation + " " + x.spec.model + "/"
                                + x.spec.deployment),
                ports_table(x));
    if (auto parameters = parameters_table(x.spec.parameters);
        !parameters.rows.empty())
      out.section("Parameters of step " + printable(x.spec.step), parameters);
  }
}

void describe_instance(page& out, const known_cell& known,
                       const std::string& name, const view_style& style) {
  const auto found = those(
      known.instances, [&](const auto& x) { return x.spec.instance == name; });
  const auto& row = found.front();
  const auto& spec = row.spec;
  out.detail("Task", spec.task);
  out.detail("Step", spec.step);
  out.detail("Node", row.node);
  out.detail("State", instance_state_text(row, style));
  out.detail("Reason", row.reason);
  out.detail("Health", row.health_reason);
  out.detail("Gives nothing", row.metrics.remark);
  out.detail("Stop-safe", safety_text(row));
  out.detail("Waits", row.waits);
  out.detail("Interrupted", time_and_age_text(row.interrupted_unix_ms, style));
  out.detail("Exit code",
             row.exit_code < 0 ? "" : std::to_string(row.exit_code));
  out.detail("Problem", row.problem);
  out.detail("Frames",
             row.metrics.frames < 0 ? "" : std::to_string(row.metrics.frames));
  out.detail("Metrics", metrics_text(row.metrics));
  out.detail("Memory", memory_text(row));
  out.detail("CPU", cpu_text(row));
  out.detail("Status text", row.status);
  out.detail("Operation", spec.operation);
  out.detail("Model", spec.model + "/" + spec.deployment);
  out.detail("Build", spec.skill.substr(0, 12));
  out.detail("Needs", resource_request_text(spec.resources));
  out.detail("GPU", spec.gpu < 0 ? "" : std::to_string(spec.gpu));
  describe_program(out, row);
  out.section("Ports", ports_table(row));
  out.section("Parameters", parameters_table(spec.parameters));
  table environment{{{"VARIABLE"}, {"VALUE"}}, {}};
  for (const auto& [key, value] : spec.environment)
    environment.rows.push_back({key, value});
  out.section("Environment", environment);
}

void describe_cell(page& out, const known_cell& known,
                   const view_style& style) {
  const auto& cell = known.cell;
  out.detail("Coordinator", cell.coordinator);
  out.detail("Address", cell.address);
  out.detail("Discovery", cell.discovery_server);
  out.detail("Incarnation",
             cell.incarnation == 0 ? "" : std::to_string(cell.incarnation));
  auto inner = style;
  inner.text.width = page::inner_width(style.text.width);
  out.section("Nodes", members_view(cell, inner));
  out.section("Tasks", tasks_view({cell.tasks}, inner));
}

json json_of(const known_cell& known, const known_thing& what) {
  switch (what.kind) {
  case thing_kind::node:
    for (const auto& row : known.cell.nodes)
      if (row.identity.name == what.name)
        return row;
    for (const auto& node : known.cell.free)
      if (node.name == what.name)
        return node;
    break;
  case thing_kind::task:
    for (const auto& row : known.cell.tasks)
      if (row.task == what.name) {
        auto result = row;
        result.instances = of_task(known, what.name);
        return result;
      }
    break;
  case thing_kind::instance:
    for (const auto& row : known.instances)
      if (row.spec.instance == what.name)
        return row;
    break;
  case thing_kind::skill:
    return builds_of(known, what.name);
  case thing_kind::cell:
    return known.cell;
  }
  return nullptr;
}

std::string printable_lines(const std::string& text) {
  std::string result;
  for (size_t at = 0; at < text.size();) {
    const auto end = std::min(text.find('\n', at), text.size());
    result += printable(std::string_view{text}.substr(at, end - at)) + "\n";
    at = end + 1;
  }
  return result;
}

std::vector<skill_row> builds_of(const known_cell& known,
                                 const std::string& operation) {
  std::vector<skill_row> result;
  std::copy_if(known.skills.skills.begin(), known.skills.skills.end(),
               std::back_inserter(result), [&](const auto& x) {
                 return x.skill.descriptor.operation == operation;
               });
  return result;
}

void describe_skill(page& out, const known_cell& known, const std::string& name,
                    const view_style& style) {
  const auto builds = builds_of(known, name);
  const auto& first = builds.front().skill.descriptor;
  out.detail("Engine", first.engine);
  out.detail("Program", joined(first.entry_point, " "));
  auto inner = style.text;
  inner.width = page::inner_width(inner.width);
  out.section("How it is used", skill_view(builds, inner));
}

namespace {

constexpr size_t shown_events = 10;

/// Which member of an event's particulars names a thing of that kind.
const char* member_of(thing_kind kind) {
  switch (kind) {
  case thing_kind::node:
    return "node";
  case thing_kind::task:
    return "task";
  case thing_kind::cell:
    return "cell";
  case thing_kind::instance:
  case thing_kind::skill:
    break;
  }
  return "";
}

} // namespace

std::vector<event> events_of(const known_cell& known, const known_thing& what) {
  std::vector<event> result;
  for (const auto& e : known.events)
    if ((e.subject == what.name
         || event_text(e, member_of(what.kind)) == what.name)
        && !is_on_the_way(e, known.asked.role))
      result.push_back(e);
  if (result.size() > shown_events)
    result.erase(result.begin(),
                 result.end() - static_cast<long>(shown_events));
  return result;
}

std::string describe_view(const known_cell& known, const known_thing& what,
                          const std::string& log, const view_style& style) {
  page out{style.text};
  out.detail("Kind", to_string(what.kind));
  out.detail("Name", what.name);
  switch (what.kind) {
  case thing_kind::node:
    describe_node(out, known, what.name, style);
    break;
  case thing_kind::task:
    describe_task(out, known, what.name, style);
    break;
  case thing_kind::instance:
    describe_instance(out, known, what.name, style);
    break;
  case thing_kind::skill:
    describe_skill(out, known, what.name, style);
    break;
  case thing_kind::cell:
    describe_cell(out, known, style);
    break;
  }
  out.section("Recent events", events_table(events_of(known, what), style));
  out.section("End of the log", printable_lines(log));
  return out.text();
}

json describe_json(const known_cell& known, const known_thing& what,
                   const std::string& log) {
  json events = json::array();
  for (const auto& e : events_of(known, what))
    events.push_back(message_json(e));
  json result{{"kind", to_string(what.kind)},
              {"name", what.name},
              {"about", shaped(json_of(known, what))},
              {"events", std::move(events)}};
  if (!log.empty())
    result["log"] = log;
  return result;
}

} // namespace roscell::cli
