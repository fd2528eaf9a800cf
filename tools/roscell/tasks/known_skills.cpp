#include "tools/roscell/tasks/known_skills.hpp"

#include "actors/instances/skills/skill_catalogue.hpp"
#include "actors/placement/reading/short_forms.hpp"
#include "actors/placement/reading/stream_names.hpp"
#include "schemas/parameters/declared_parameter.hpp"
#include "schemas/text_excerpt.hpp"
#include "tools/roscell/exit_code.hpp"
#include "tools/roscell/view/format.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>
#include <string_view>
#include <utility>

namespace roscell::cli {

namespace {

skill_list skills_in(const std::vector<std::string>& folders) {
  const auto found = skill_catalogue::scan({folders.begin(), folders.end()});
  skill_list result;
  for (const auto& skill : found.skills())
    result.skills.push_back({skill, {"here"}, {skill.added_unix_ms}});
  for (const auto& problem : found.problems())
    result.refused.push_back({"here", problem});
  if (result.skills.empty())
    throw command_error{exit_usage, "no skill is in " + joined(folders, ", "),
                        result.refused.empty()
                            ? "--skills takes a folder of skill folders, such "
                              "as build/release/skills"
                            : result.refused.front().problem.path + ": "
                                  + result.refused.front().problem.message};
  return result;
}

} // namespace

void add_skill_source(CLI::App& command, skill_source& source) {
  command
      .add_option("--skills", source.folders,
                  "Look for skills in the folders of this directory instead of "
                  "asking a node; can be repeated")
      ->option_text("DIR")
      ->allow_extra_args(false);
  add_connection_options(command, source.connection);
}

skill_list find_skills(const skill_source& source) {
  if (!source.folders.empty())
    return skills_in(source.folders);
  return node_client{source.connection}.get("/v1/skills").get<skill_list>();
}

std::vector<skill_row> rows_of(const skill_list& skills,
                               const std::string& operation) {
  std::vector<skill_row> result;
  std::set<std::string> known;
  for (const auto& row : skills.skills) {
    known.insert(row.skill.descriptor.operation);
    if (row.skill.descriptor.operation == operation)
      result.push_back(row);
  }
  if (!result.empty())
    return result;
  const auto meant = closest_word(operation, {known.begin(), known.end()});
  throw command_error{
      exit_refused, "no skill does '" + printable(operation) + "'",
      meant.empty()
          ? "the operations are: " + joined({known.begin(), known.end()}, ", ")
          : "did you mean '" + std::string{meant} + "'?"};
}

namespace {

/// A file's ending for a type that files have.
std::string ending_for(const std::string& type) {
  static const std::map<std::string, std::string> endings{
      {"image/png", ".png"},
      {"image/jpeg", ".jpg"},
      {"application/json", ".jsonl"},
      {"text/plain", ".txt"}};
  const auto known = endings.find(type);
  return known == endings.end() ? "" : known->second;
}

bool speaks(const port_description& port, const std::string& protocol) {
  return std::find(port.protocols.begin(), port.protocols.end(), protocol)
         != port.protocols.end();
}

/// The first type that a protocol carries; empty if none.
std::string first_type(const port_description& port, bool message) {
  for (const auto& type : port.data_types)
    if (is_message_type(type) == message)
      return type;
  return {};
}

/// Text of an end, valid as it is.
std::string placeholder(const port_description& port, const std::string& path) {
  const auto file_type = first_type(port, false);
  if (speaks(port, "file") && !file_type.empty())
    return "/tmp/" + path + ending_for(file_type);
  if (speaks(port, "video"))
    return "/dev/video0";
  return "/" + path + "/" + type_name(first_type(port, true));
}

/// Of several builds the one that is easiest to try: it reads files, and asks
/// for the least memory.
skill_row easiest(const std::vector<skill_row>& rows) {
  const auto cost = [](const skill_row& x) {
    const auto& skill = x.skill.descriptor;
    const auto& option = skill.models.front().deployments.front();
    return std::pair{!speaks(skill.input, "file"), option.resources.memory_mib};
  };
  return *std::min_element(
      rows.begin(), rows.end(),
      [&](const auto& x, const auto& y) { return cost(x) < cost(y); });
}

/// `  # or: NAME, NAME`, the models besides the first one of a build.
std::string other_models(const std::vector<skill_row>& rows,
                         const std::string& chosen) {
  std::set<std::string> names;
  for (const auto& row : rows)
    for (const auto& model : row.skill.descriptor.models)
      if (model.name != chosen)
        names.insert(model.name);
  return names.empty()
             ? ""
             : "  # or: " + joined({names.begin(), names.end()}, ", ");
}

class skeleton {
public:
  skeleton(std::string task, const skill_list& skills)
      : task_(std::move(task)), skills_(skills) {}

  void add(const std::string& operation) {
    const auto rows = rows_of(skills_, operation);
    const auto skill = easiest(rows).skill.descriptor;
    task_step step;
    step.id = unused_id(operation);
    step.operation = operation;
    step.model = skill.models.front().name;
    const bool joined = join(step);
    text_ += "\n  - id: " + step.id + "\n    operation: " + operation
             + "\n    model: " + step.model + other_models(rows, step.model)
             + "\n" + input_text(skill.input, step, joined)
             + output_text(skill.output, step)
             + parameters_text(skill, skill.models.front());
    steps_.push_back(step);
  }

  std::string text() const {
    return "# Fill in what is marked, then:\n"
           "#   roscell check --to NODE FILE    what is wrong with it\n"
           "#   roscell run --to NODE FILE      start it\n"
           "type: task_request\ntask: "
           + task_ + "\npipeline:" + text_;
  }

private:
  std::string unused_id(const std::string& operation) const {
    const auto used =
        std::count_if(steps_.begin(), steps_.end(),
                      [&](const auto& x) { return x.operation == operation; });
    return used == 0 ? operation : operation + "_" + std::to_string(used + 1);
  }

  /// Whether the step can read what the one before it writes; it then does.
  bool join(task_step& step) const {
    if (steps_.empty())
      return false;
    step.input = {{"", "", "", steps_.back().id, false}};
    auto both = std::vector<task_step>{steps_.back(), step};
    // What that one reads in turn does not matter here.
    both[0].input.clear();
    if (write_out(task_, both, skills_, "").errors.empty())
      return true;
    step.input.clear();
    return false;
  }

  std::string input_text(const port_description& port, task_step& step,
                         bool joined) const {
    const auto takes = "    # takes " + roscell::joined(port.data_types, ", ")
                       + " by " + roscell::joined(port.protocols, ", ") + "\n";
    if (joined)
      return takes + "    input: {from: " + steps_.back().id + "}\n";
    const auto path = task_ + "/" + step.id + "_input";
    const auto end = placeholder(
        port, speaks(port, "file") ? path : topic_word(task_) + "/input");
    step.input = {io_endpoint::from_text(end)};
    if (!is_topic(end) || looks_like_file(end))
      return takes + "    input: " + end + "  # fill in\n";
    return takes + "    input:\n      endpoint: " + end
           + "  # fill in\n      external: true  # a program that ROSCell does "
             "not start writes it\n";
  }

  /// Topics are made up where a step reads them; a file is not.
  std::string output_text(const port_description& port, task_step& step) const {
    auto gives = "    # gives " + joined(port.data_types, ", ") + " by "
                 + joined(port.protocols, ", ") + "\n";
    if (!speaks(port, "file"))
      return gives;
    const auto end = placeholder(port, task_ + "/" + step.id);
    step.output = {io_endpoint::from_text(end)};
    return gives + "    output: " + end + "  # fill in\n";
  }

  static std::string parameters_text(const skill_descriptor& skill,
                                     const implementation_model& model) {
    std::string lines;
    const auto own = model.parameters.empty() ? json::object()
                                              : json::parse(model.parameters);
    for (const auto& [name, x] : parameters_of(skill, model)) {
      if (!own.contains(name))
        continue;
      lines += "    #   " + name + ": "
               + (x.value.is_null() ? "..." : x.value.dump()) + "  # "
               + parameter_text(x)
               + (x.description.empty() ? "" : ": " + x.description) + "\n";
    }
    return lines.empty() ? "" : "    # parameters:\n" + lines;
  }

  const std::string task_;
  const skill_list& skills_;
  std::vector<task_step> steps_;
  std::string text_;
};

} // namespace

std::string task_skeleton(const std::string& task,
                          const std::vector<std::string>& operations,
                          const skill_list& skills) {
  skeleton result{task, skills};
  for (const auto& operation : operations)
    result.add(operation);
  return result.text();
}

} // namespace roscell::cli
