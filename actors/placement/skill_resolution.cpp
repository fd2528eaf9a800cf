#include "actors/placement/skill_resolution.hpp"

#include <algorithm>
#include <map>
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

/// Of a few folders that nodes have refused: the skill may be in one of them.
std::string refusals_of(const skill_list& known) {
  constexpr size_t most_shown = 3;
  std::string result;
  for (size_t i = 0; i < known.refused.size() && i < most_shown; ++i) {
    const auto& [node, problem] = known.refused[i];
    result += "; node '" + node + "' refuses " + problem.path + ": ";
    if (!problem.where.empty())
      result += "at " + problem.where + ": ";
    result += problem.message;
  }
  if (known.refused.size() > most_shown)
    result += "; `roscell skills` shows more";
  return result;
}

const implementation_model* find_model(const skill_descriptor& descriptor,
                                       const std::string& name) {
  for (const auto& model : descriptor.models)
    if (model.name == name)
      return &model;
  return nullptr;
}

int64_t added_on(const skill_row& row, size_t node) {
  return node < row.added_unix_ms.size() ? row.added_unix_ms[node] : 0;
}

int64_t last_added(const skill_row& row) {
  const auto& xs = row.added_unix_ms;
  return xs.empty() ? 0 : *std::max_element(xs.begin(), xs.end());
}

/// A build that may do the step, and what of it does so.
struct fitting_build {
  const skill_row* row;
  implementation_model model;
};

/// Leaves only the builds that can do a step, rule by rule. Where a rule
/// leaves none, it says why.
class step_resolver {
public:
  step_resolver(const task_step& step, const skill_list& skills,
                std::string pointer)
      : step_(step), pointer_(std::move(pointer)) {
    keep_operation(skills);
  }

  std::variant<resolved_step, failure> resolve() {
    for (auto rule : {&step_resolver::keep_build, &step_resolver::keep_model,
                      &step_resolver::keep_deployment,
                      &step_resolver::keep_ports, &step_resolver::keep_life}) {
      if (!problem_)
        (this->*rule)();
    }
    if (problem_)
      return *problem_;
    return resolved_step{step_, builds()};
  }

private:
  void refuse(error_code code, const std::string& place, std::string message,
              std::string hint) {
    problem_ =
        failure{code, std::move(message), pointer_ + place, std::move(hint)};
  }

  template <class Predicate>
  void keep_if(Predicate fits) {
    candidates_.erase(
        std::remove_if(candidates_.begin(), candidates_.end(),
                       [&](fitting_build& x) { return !fits(x); }),
        candidates_.end());
  }

  void keep_operation(const skill_list& known) {
    for (const auto& row : known.skills)
      if (row.skill.descriptor.operation == step_.operation)
        candidates_.push_back({&row, {}});
    std::stable_sort(candidates_.begin(), candidates_.end(),
                     [](const auto& x, const auto& y) {
                       return last_added(*x.row) > last_added(*y.row);
                     });
    if (candidates_.empty())
      refuse(error_code::unknown_operation, "/operation",
             "no skill of this cell does '" + step_.operation + "'",
             "the operations are: "
                 + names_of(known.skills,
                            [](const skill_row& x) {
                              return x.skill.descriptor.operation;
                            })
                 + refusals_of(known));
  }

  void keep_build() {
    constexpr size_t shown_digits = 12;
    const auto known = names_of(candidates_, [](const fitting_build& x) {
      return x.row->skill.hash.substr(0, shown_digits);
    });
    keep_if([&](const fitting_build& x) {
      return x.row->skill.hash.compare(0, step_.build.size(), step_.build) == 0;
    });
    if (candidates_.empty())
      refuse(error_code::unknown_operation, "/build",
             "no node of this cell has a build '" + step_.build + "' of '"
                 + step_.operation + "'",
             "its builds are: " + known);
  }

  void keep_model() {
    std::vector<implementation_model> models;
    for (const auto& x : candidates_)
      models.insert(models.end(), x.row->skill.descriptor.models.begin(),
                    x.row->skill.descriptor.models.end());
    keep_if([&](fitting_build& x) {
      const auto* model = find_model(x.row->skill.descriptor, step_.model);
      if (model != nullptr)
        x.model = *model;
      return model != nullptr;
    });
    if (candidates_.empty())
      refuse(error_code::unknown_model, "/model",
             "'" + step_.operation + "' has no model '" + step_.model + "'",
             "its models are: "
                 + names_of(models, [](const implementation_model& x) {
                     return x.name;
                   }));
  }

  void keep_deployment() {
    if (step_.deployment.empty())
      return;
    std::vector<deployment_option> known;
    keep_if([&](fitting_build& x) {
      auto& options = x.model.deployments;
      known.insert(known.end(), options.begin(), options.end());
      options.erase(std::remove_if(options.begin(), options.end(),
                                   [&](const auto& option) {
                                     return option.name != step_.deployment;
                                   }),
                    options.end());
      return !options.empty();
    });
    if (candidates_.empty())
      refuse(error_code::unknown_deployment, "/deployment",
             "model '" + step_.model + "' has no deployment option '"
                 + step_.deployment + "'",
             "its deployment options are: "
                 + names_of(known,
                            [](const deployment_option& x) { return x.name; }));
  }

  /// What the newest build does not take is said where none takes it.
  void keep_ports() {
    std::optional<failure> first;
    keep_if([&](const fitting_build& x) {
      const auto& descriptor = x.row->skill.descriptor;
      check_ports("/input", step_.input, descriptor.input);
      if (!problem_)
        check_ports("/output", step_.output, descriptor.output);
      if (!first)
        first = problem_;
      return !std::exchange(problem_, std::nullopt);
    });
    if (candidates_.empty())
      problem_ = first;
  }

  /// The same for how the step is to live, deployment by deployment.
  void keep_life() {
    std::optional<failure> first;
    keep_if([&](fitting_build& x) {
      auto& options = x.model.deployments;
      const auto cannot = [&](const deployment_option& option) {
        auto why = check_life(step_, option, x.row->skill.descriptor);
        if (!first)
          first = why;
        return why.has_value();
      };
      options.erase(std::remove_if(options.begin(), options.end(), cannot),
                    options.end());
      return !options.empty();
    });
    if (candidates_.empty() && first)
      refuse(first->code, first->where, first->message, first->hint);
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

  /// The node of each build on which no newer one is left.
  std::vector<skill_build> builds() {
    std::map<std::string, std::pair<int64_t, size_t>> newest; // by node
    for (size_t i = 0; i < candidates_.size(); ++i) {
      const auto& row = *candidates_[i].row;
      for (size_t n = 0; n < row.nodes.size(); ++n) {
        const auto added = added_on(row, n);
        const auto [known, is_first] =
            newest.try_emplace(row.nodes[n], added, i);
        if (!is_first && added > known->second.first)
          known->second = {added, i};
      }
    }
    std::vector<skill_build> result;
    for (auto& x : candidates_)
      result.push_back({x.row->skill.hash,
                        std::move(x.model),
                        {},
                        x.row->skill.descriptor.safe_state,
                        x.row->lacking,
                        x.row->bytes});
    for (const auto& [node, choice] : newest)
      result[choice.second].nodes.push_back(node);
    if (!newest.empty())
      result.erase(
          std::remove_if(result.begin(), result.end(),
                         [](const auto& x) { return x.nodes.empty(); }),
          result.end());
    return result;
  }

  const task_step& step_;
  std::string pointer_;
  std::vector<fitting_build> candidates_; ///< The newest first.
  std::optional<failure> problem_;
};

} // namespace

std::variant<std::vector<resolved_step>, failure>
resolve_steps(const std::vector<task_step>& pipeline, const skill_list& skills,
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
