#include "tools/roscell/view/task_replies.hpp"

#include "actors/edge/process/skill_grants.hpp"
#include "messages/task.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

namespace {

std::string placed_view(const std::vector<placed_instance>& instances,
                        const text_style& style) {
  table t{{{"STEP"}, {"NODE"}, {"INSTANCE"}}, {}};
  for (const auto& x : instances)
    t.rows.push_back({x.step, x.node, x.instance});
  return t.render(style);
}

} // namespace

namespace {

/// What has become of a task by the request, or was so before.
std::string found_text(const task_accepted& task) {
  switch (task.found) {
  case task_found::started:
    return " runs";
  case task_found::anew:
    return " runs once more, run " + std::to_string(task.run);
  case task_found::running:
    return task.healed.empty() ? " runs already" : " runs";
  case task_found::degraded:
    return " is degraded";
  case task_found::finished:
    return " has finished, and was asked for by this request_id or by none: a "
           "new one starts it once more";
  case task_found::failed:
    break;
  }
  return " has failed, and was asked for by this request_id: a new one starts "
         "it once more";
}

} // namespace

std::string accepted_view(const task_accepted& task, const text_style& style) {
  auto text = "task " + printable(task.task) + found_text(task);
  if (!task.optimal)
    text += ", maybe not where it would be best";
  text += "\n\n" + placed_view(task.instances, style);
  if (!task.healed.empty())
    text += "\nstarted again: " + printable(joined(task.healed, ", ")) + "\n";
  for (const auto& x : task.preempted)
    text += "\npreempted: " + printable(x.task + "/" + x.step + " on " + x.node)
            + "\n";
  return text;
}

std::string restarted_view(const task_restarted& task,
                           const text_style& style) {
  return "task " + printable(task.task) + ": started again\n\n"
         + placed_view(task.instances, style);
}

std::string waiting_text(const safety_wait& wait) {
  return printable("waits for '" + wait.task + "/" + wait.step + "' on "
                   + wait.node + " to be stop-safe");
}

std::string terminated_view(const task_terminated& task) {
  const auto count = task.instances.size();
  auto text = "task " + printable(task.task) + " is gone, with "
              + std::to_string(count)
              + (count == 1 ? " instance\n" : " instances\n");
  if (!task.waiting.empty())
    text = "task " + printable(task.task) + " is ending\n";
  for (const auto& wait : task.waiting)
    text += waiting_text(wait) + "\n";
  if (!task.pending_nodes.empty())
    text += "away, to remove theirs when they are back: "
            + printable(joined(task.pending_nodes, ", ")) + "\n";
  return text;
}

namespace {

std::string number(double value) {
  return format_significant(value, 4);
}

std::string bound_text(const cell_rebalanced& report) {
  if (report.optimal)
    return "no placement is better";
  return "no placement is below " + number(report.lower_bound);
}

} // namespace

std::string rebalance_view(const cell_rebalanced& report,
                           const text_style& style) {
  const auto cell = "cell '" + printable(report.cell) + "': ";
  if (report.moves.empty())
    return cell + "no move is worth it; total " + number(report.before) + ", "
           + bound_text(report) + "\n";
  table t{{{"MOVE", align::right},
           {"TASK"},
           {"STEP"},
           {"FROM"},
           {"TO"},
           {"GAIN", align::right},
           {"STATE"}},
          {}};
  for (size_t i = 0; i < report.moves.size(); ++i) {
    const auto& x = report.moves[i];
    t.rows.push_back({std::to_string(i + 1), x.task, x.step, x.from, x.to,
                      number(x.gain), std::string{to_word(x.state)}});
  }
  return t.render(style) + "\n" + cell + "total " + number(report.before)
         + " -> " + number(report.after) + ", " + bound_text(report) + "\n";
}

namespace {

int64_t last_added(const skill_row& row) {
  const auto& xs = row.added_unix_ms;
  return xs.empty() ? 0 : *std::max_element(xs.begin(), xs.end());
}

std::string port_line(const char* name, const port_description& port) {
  return std::string{name} + printable(joined(port.data_types, ", "))
         + "\n       by " + printable(joined(port.protocols, ", ")) + "\n";
}

/// What the node must have, and what it must grant.
std::string requirements_of(const std::string& skill,
                            const deployment_option& x) {
  std::vector<std::string> words = x.devices;
  for (const auto& [name, value] : x.labels)
    words.push_back(name + "=" + value);
  for (const auto& what : skill_grants{}.missing(skill, x))
    words.push_back(what);
  return joined(words);
}

std::string deployments_view(const std::string& skill,
                             const implementation_model& model,
                             const text_style& style) {
  table t{{{"DEPLOYMENT"},
           {"RUNS ON"},
           {"CPU (cores)", align::right},
           {"MEMORY", align::right},
           {"DISK", align::right},
           {"GPU MEMORY", align::right},
           {"WANTS"}},
          {}};
  constexpr double bytes_per_mib = 1024.0 * 1024.0;
  for (const auto& x : model.deployments) {
    const auto& r = x.resources;
    t.rows.push_back(
        {x.name, joined(x.architectures), format_number(r.cpu),
         format_bytes(r.memory_mib * bytes_per_mib),
         format_bytes(r.disk_mib * bytes_per_mib),
         r.needs_gpu() ? format_bytes(r.gpu_memory_mib * bytes_per_mib) : "",
         requirements_of(skill, x)});
  }
  return t.render(style);
}

/// `  tag_size_m  0.08  a number from 0.0001 to 100 (m)`, and what it means
/// below.
std::string parameter_lines(const std::string& name,
                            const declared_parameter& x,
                            const text_style& style) {
  const auto value = x.value.is_null() ? "" : ": " + x.value.dump();
  auto lines = "  " + printable(name) + value + ", " + parameter_text(x)
               + (x.changeable ? ", changeable" : "");
  if (style.width > 0)
    lines = shortened(lines, style.width);
  return lines + "\n"
         + (x.description.empty() ? ""
                                  : "      " + printable(x.description) + "\n");
}

/// The model's own parameters come before those of the engine.
std::string parameters_view(const skill_descriptor& skill,
                            const implementation_model& model,
                            const text_style& style) {
  const auto own =
      model.parameters.empty() ? json::object() : json::parse(model.parameters);
  std::string text;
  for (const bool engine : {false, true}) {
    std::string lines;
    for (const auto& [name, x] : parameters_of(skill, model))
      if (own.contains(name) != engine)
        lines += parameter_lines(name, x, style);
    if (!lines.empty())
      text += std::string{text.empty() ? "" : "\n"}
              + (engine ? "parameters of the engine and its protocols:\n"
                        : "parameters:\n")
              + lines;
  }
  return text.empty() ? "no parameters\n" : text;
}

} // namespace

std::string skill_view(const std::vector<skill_row>& rows,
                       const text_style& style) {
  std::string text;
  std::vector<skill_row> newest = rows;
  std::sort(newest.begin(), newest.end(), [](const auto& x, const auto& y) {
    return last_added(x) > last_added(y);
  });
  constexpr size_t short_hash = 12;
  for (const auto& row : newest) {
    const auto& skill = row.skill.descriptor;
    text += printable(skill.operation) + ", build "
            + row.skill.hash.substr(0, short_hash) + " on "
            + printable(joined(row.nodes, ", ")) + "\n"
            + port_line("takes  ", skill.input)
            + port_line("gives  ", skill.output);
    for (const auto& model : skill.models)
      text += "\nmodel " + printable(model.name) + "\n\n"
              + deployments_view(skill.operation, model, style) + "\n"
              + parameters_view(skill, model, style);
    text += &row == &newest.back() ? "" : "\n";
  }
  return text;
}

} // namespace roscell::cli
