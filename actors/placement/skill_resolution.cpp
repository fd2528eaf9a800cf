#include "actors/placement/skill_resolution.hpp"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

namespace roscell {

namespace {

/// `a, b, c`, each once; `none` for an empty list.
template <class Range, class Name>
std::string names_of(const Range& range, Name name) {
  std::string result;
  std::set<std::string> seen;
  for (const auto& x : range)
    if (seen.insert(name(x)).second)
      result += (result.empty() ? "" : ", ") + name(x);
  return result.empty() ? "none" : result;
}

const implementation_model* find_model(const skill_descriptor& descriptor,
                                       const std::string& name) {
  for (const auto& model : descriptor.models)
    if (model.name == name)
      return &model;
  return nullptr;
}

/// The skill of a step, and where its other parts are looked up.
class step_resolver {
public:
  step_resolver(const task_step& step, const std::vector<skill_row>& skills,
                std::string pointer)
      : step_(step), pointer_(std::move(pointer)) {
    for (const auto& row : skills)
      if (row.skill.descriptor.operation == step.operation)
        candidates_.push_back(&row);
    if (candidates_.empty())
      refuse(error_code::unknown_operation, "/operation",
             "no skill of this cell does '" + step.operation + "'",
             "the operations are: " + names_of(skills, [](const skill_row& x) {
               return x.skill.descriptor.operation;
             }));
  }

  std::variant<resolved_step, failure> resolve() {
    if (!problem_)
      choose_row();
    if (!problem_)
      choose_deployments();
    if (!problem_)
      check_ports("/input", step_.input, result_.skill.descriptor.input);
    if (!problem_)
      check_ports("/output", step_.output, result_.skill.descriptor.output);
    if (problem_)
      return *problem_;
    result_.step = step_;
    return std::move(result_);
  }

private:
  void refuse(error_code code, const std::string& place, std::string message,
              std::string hint) {
    problem_ =
        failure{code, std::move(message), pointer_ + place, std::move(hint)};
  }

  void choose_row() {
    const skill_row* best = nullptr;
    for (const auto* row : candidates_)
      if (find_model(row->skill.descriptor, step_.model)
          && (!best || row->nodes.size() > best->nodes.size()))
        best = row;
    if (!best) {
      std::vector<implementation_model> models;
      for (const auto* row : candidates_)
        models.insert(models.end(), row->skill.descriptor.models.begin(),
                      row->skill.descriptor.models.end());
      refuse(error_code::unknown_model, "/model",
             "'" + step_.operation + "' has no model '" + step_.model + "'",
             "its models are: "
                 + names_of(models, [](const implementation_model& x) {
                     return x.name;
                   }));
      return;
    }
    result_.skill = best->skill;
    result_.nodes = best->nodes;
    result_.model = *find_model(best->skill.descriptor, step_.model);
  }

  void choose_deployments() {
    if (step_.deployment.empty())
      return;
    auto& options = result_.model.deployments;
    const auto known =
        names_of(options, [](const deployment_option& x) { return x.name; });
    options.erase(std::remove_if(options.begin(), options.end(),
                                 [&](const auto& x) {
                                   return x.name != step_.deployment;
                                 }),
                  options.end());
    if (options.empty())
      refuse(error_code::unknown_deployment, "/deployment",
             "model '" + step_.model + "' has no deployment option '"
                 + step_.deployment + "'",
             "its deployment options are: " + known);
  }

  void check_ports(const std::string& place,
                   const std::vector<io_endpoint>& endpoints,
                   const port_description& port) {
    for (size_t i = 0; i < endpoints.size() && !problem_; ++i) {
      const auto at =
          endpoints.size() == 1 ? place : place + "/" + std::to_string(i);
      check_word(at + "/protocol", "protocol", endpoints[i].protocol,
                 port.protocols);
      if (!problem_)
        check_word(at + "/data_type", "data type", endpoints[i].data_type,
                   port.data_types);
    }
  }

  void check_word(const std::string& place, const std::string& what,
                  const std::string& word,
                  const std::vector<std::string>& known) {
    if (std::find(known.begin(), known.end(), word) != known.end())
      return;
    refuse(error_code::schema_violation, place,
           "'" + step_.operation + "' does not take the " + what + " '" + word
               + "' here",
           "it takes: "
               + names_of(known, [](const std::string& x) { return x; }));
  }

  const task_step& step_;
  std::string pointer_;
  std::vector<const skill_row*> candidates_;
  std::optional<failure> problem_;
  resolved_step result_;
};

} // namespace

std::variant<std::vector<resolved_step>, failure>
resolve_steps(const std::vector<task_step>& pipeline,
              const std::vector<skill_row>& skills,
              const std::string& pointer) {
  std::vector<resolved_step> result;
  for (size_t i = 0; i < pipeline.size(); ++i) {
    step_resolver resolver{pipeline[i], skills,
                           pointer + "/" + std::to_string(i)};
    auto resolved = resolver.resolve();
    if (auto* problem = std::get_if<failure>(&resolved))
      return std::move(*problem);
    result.push_back(std::get<resolved_step>(std::move(resolved)));
  }
  return result;
}

} // namespace roscell
