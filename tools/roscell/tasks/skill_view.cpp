#include "actors/edge/process/skill_grants.hpp"
#include "schemas/parameters/engine_parameters.hpp"
#include "tools/roscell/tasks/task_view.hpp"
#include "tools/roscell/view/format.hpp"

#include <algorithm>

namespace roscell::cli {

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
