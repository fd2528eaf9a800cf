#include "actors/cell/updates/update_plan.hpp"

#include "actors/placement/instance_specs.hpp"

#include <algorithm>
#include <map>
#include <utility>

namespace roscell {

namespace {

constexpr size_t longest_value = 40;
constexpr size_t most_reasons = 8;

std::string value_text(const json& value) {
  if (value.is_null())
    return "none";
  auto text = value.is_string()
                  ? value.get<std::string>()
                  : value.dump(-1, ' ', false, json::error_handler_t::replace);
  return text.size() > longest_value ? text.substr(0, longest_value) + "..."
                                     : text;
}

json member_of(const json& object, const std::string& name) {
  const auto found = object.find(name);
  return found == object.end() ? json{} : *found;
}

/// Adds "a.b: 1 -> 2" for each value that differs.
void add_differences(const std::string& path, const json& before,
                     const json& now, std::vector<std::string>& to) {
  if (before == now)
    return;
  // What is empty is left out.
  if (before.is_null() && now.is_object())
    return add_differences(path, json::object(), now, to);
  if (before.is_object() && now.is_null())
    return add_differences(path, before, json::object(), to);
  if (before.is_object() && now.is_object()) {
    std::set<std::string> names;
    for (const auto& [name, value] : before.items())
      names.insert(name);
    for (const auto& [name, value] : now.items())
      names.insert(name);
    for (const auto& name : names)
      add_differences(path.empty() ? name : path + "." + name,
                      member_of(before, name), member_of(now, name), to);
    return;
  }
  if (before.is_array() && now.is_array() && before.size() == now.size()) {
    for (size_t i = 0; i < now.size(); ++i)
      add_differences(path + "[" + std::to_string(i) + "]", before[i], now[i],
                      to);
    return;
  }
  // What an environment holds may be secret.
  const bool is_hidden = path.compare(0, 12, "environment.") == 0;
  to.push_back(is_hidden ? path
                         : path + ": " + value_text(before) + " -> "
                               + value_text(now));
}

void forget_writers(std::vector<io_endpoint>& ends) {
  for (auto& x : ends)
    x.from.clear();
}

/// What of an instance is its step's: a builder of JSON that can be compared.
json comparable(instance_spec x,
                const std::set<std::string>& cell_environment) {
  forget_writers(x.input);
  forget_writers(x.output);
  for (const auto& name : cell_environment)
    x.environment.erase(name);
  json result = x;
  for (const auto* name : {"instance", "task", "step", "cell", "gpu"})
    result.erase(name);
  result.erase("skill");
  result["build"] = x.skill;
  return result;
}

const skill_build* build_on(const resolved_step& step,
                            const std::string& node) {
  for (const auto& build : step.builds)
    if (std::count(build.nodes.begin(), build.nodes.end(), node) > 0)
      return &build;
  return nullptr;
}

const skill_build* build_of(const resolved_step& step,
                            const std::string& hash) {
  for (const auto& build : step.builds)
    if (build.hash == hash)
      return &build;
  return nullptr;
}

/// The deployment that it has, if the build still has it, or the first one.
std::string deployment_on(const skill_build& build, const std::string& now) {
  const auto& options = build.model.deployments;
  const bool has = std::any_of(options.begin(), options.end(),
                               [&](const auto& x) { return x.name == now; });
  return has || options.empty() ? now : options.front().name;
}

/// What the step would be on the node where it is.
std::optional<instance_spec> spec_there(const planned_step& x,
                                        const skill_build& build) {
  if (build.model.deployments.empty())
    return std::nullopt;
  allocated_task alone;
  alone.request.task = x.old->spec.task;
  alone.steps = {x.step};
  step_allocation place;
  place.step = x.step.step.id;
  place.node = x.old->node;
  place.deployment = deployment_on(build, x.old->spec.deployment);
  place.gpu = x.old->spec.gpu;
  place.build = build.hash;
  alone.plan.allocations = {place};
  return make_specs(alone).front();
}

/// The first label that its node does not have; empty: it has all of them.
std::string missing_label(const planned_step& x,
                          const update_question& question) {
  const auto known = question.labels.find(x.old->node);
  if (known == question.labels.end())
    return {};
  for (const auto& [name, value] : x.step.step.labels) {
    const auto found = known->second.find(name);
    if (found == known->second.end() || found->second != value)
      return name + "=" + value;
  }
  return {};
}

/// Says why a step has another instance, and which way.
void change(planned_step& x, step_action action, const std::string& reason) {
  x.change.action = action;
  x.change.reasons = {reason};
}

void compare_step(planned_step& x, const update_question& question) {
  const auto& node = x.old->node;
  const bool is_away = question.away.count(node) > 0;
  const auto* build =
      is_away ? build_of(x.step, x.old->spec.skill) : build_on(x.step, node);
  // Who is away may have it, and nobody can say so.
  if (!build && is_away)
    return;
  if (!build)
    return change(x, step_action::moves,
                  "node '" + node + "' cannot run it any more");
  if (const auto label = missing_label(x, question); !label.empty())
    return change(x, step_action::moves,
                  "node '" + node + "' does not have the label " + label);
  const auto now = spec_there(x, *build);
  std::vector<std::string> reasons;
  if (now)
    add_differences("", comparable(x.old->spec, question.cell_environment),
                    comparable(*now, question.cell_environment), reasons);
  if (question.restart_all && reasons.empty())
    reasons.emplace_back("every step is restarted");
  if (reasons.empty())
    return;
  if (reasons.size() > most_reasons) {
    const auto more = reasons.size() - most_reasons;
    reasons.resize(most_reasons);
    reasons.push_back("and " + std::to_string(more) + " more");
  }
  x.change.action = step_action::restarts;
  x.change.reasons = std::move(reasons);
}

planned_step plan_step(const resolved_step& step,
                       const update_question& question) {
  planned_step result;
  result.step = step;
  result.change.step = step.step.id;
  for (const auto& x : question.placed)
    if (x.spec.step == step.step.id)
      result.old = x;
  if (!result.old) {
    change(result, step_action::starts, "the task did not have it");
    return result;
  }
  result.change.instance = result.old->spec.instance;
  result.change.from = result.old->node;
  compare_step(result, question);
  if (!result.is_fresh())
    result.change.to = result.old->node;
  return result;
}

std::vector<std::string> only_there(const std::vector<std::string>& nodes,
                                    const std::string& node) {
  const bool has = std::count(nodes.begin(), nodes.end(), node) > 0;
  return has ? std::vector<std::string>{node} : std::vector<std::string>{};
}

/// What shares files with a step that stays goes where that is.
void keep_beside(std::vector<planned_step>& steps) {
  std::map<uint64_t, std::string> places;
  for (const auto& x : steps)
    if (x.step.together != 0 && !x.is_fresh() && x.old)
      places[x.step.together] = x.old->node;
  for (auto& x : steps) {
    const auto place = places.find(x.step.together);
    if (place == places.end() || !x.is_fresh())
      continue;
    for (auto& build : x.step.builds)
      build.nodes = only_there(build.nodes, place->second);
  }
}

} // namespace

bool update_plan::changes_steps() const {
  return !dropped.empty()
         || std::any_of(steps.begin(), steps.end(),
                        [](const auto& x) { return x.is_fresh(); });
}

std::vector<deployment> update_plan::former() const {
  auto result = dropped;
  for (const auto& x : steps)
    if (x.is_fresh() && x.old)
      result.push_back(*x.old);
  return result;
}

std::vector<step_change> update_plan::changes() const {
  std::vector<step_change> result;
  for (const auto& x : steps)
    result.push_back(x.change);
  for (const auto& x : dropped)
    result.push_back({x.spec.step,
                      step_action::stops,
                      x.spec.instance,
                      x.node,
                      "",
                      {"the task has it no more"}});
  return result;
}

update_plan compare_steps(const update_question& question) {
  update_plan result;
  for (const auto& step : question.steps)
    result.steps.push_back(plan_step(step, question));
  keep_beside(result.steps);
  for (const auto& x : question.placed)
    if (std::none_of(question.steps.begin(), question.steps.end(),
                     [&](const auto& y) { return y.step.id == x.spec.step; }))
      result.dropped.push_back(x);
  return result;
}

std::vector<std::string> compare_requests(const task_request& before,
                                          const task_request& now) {
  const auto whole = [](task_request x) {
    x.pipeline.clear();
    auto result = json(x);
    for (const auto* name :
         {"preempt", "force", "replace", "request_id", "pipeline"})
      result.erase(name);
    return result;
  };
  std::vector<std::string> result;
  add_differences("", whole(before), whole(now), result);
  return result;
}

} // namespace roscell
