#include "actors/task_allocation.hpp"

#include "actors/allocation/allocation.hpp"
#include "actors/skill_resolution.hpp"

#include <utility>

namespace roscell {

namespace {

allocation::amount convert(const amount& x) {
  return {x.capacity, x.used};
}

allocation::node convert(const node_resources& x) {
  allocation::node result{x.name,
                          x.architecture,
                          x.unified_memory,
                          convert(x.cpu),
                          convert(x.memory_mib),
                          convert(x.disk_mib),
                          {},
                          x.labels,
                          x.devices};
  for (const auto& gpu : x.gpus)
    result.gpus.push_back({gpu.index, convert(gpu.memory_mib)});
  return result;
}

allocation::deployment convert(const deployment_option& x) {
  const auto& r = x.resources;
  return {x.name,
          x.architectures,
          r.cpu,
          r.memory_mib,
          r.disk_mib,
          r.needs_gpu(),
          r.needs_gpu() ? r.gpu_memory_mib : 0,
          x.devices,
          x.labels};
}

allocation::problem convert(const allocate_task& asked) {
  allocation::problem result;
  for (const auto& node : asked.nodes)
    result.nodes.push_back(convert(node));
  for (const auto& x : asked.steps) {
    allocation::step step{
        x.step.id, {}, x.step.labels, {x.nodes.begin(), x.nodes.end()}};
    for (const auto& option : x.model.deployments)
      step.deployments.push_back(convert(option));
    result.steps.push_back(std::move(step));
  }
  return result;
}

/// Puts names where the search speaks of positions.
class plan_writer {
public:
  plan_writer(const allocate_task& asked, const allocation::result& found)
      : asked_(asked), found_(found) {}

  task_plan plan() const {
    task_plan result;
    result.task = asked_.task;
    result.optimal = found_.optimal();
    result.score = {found_.value.total, found_.value.balance,
                    found_.value.load};
    for (const auto& x : found_.placements)
      result.allocations.push_back(describe(x));
    result.rejected = rejected();
    result.warnings = found_.warnings;
    return result;
  }

  std::vector<rejected_candidate> rejected() const {
    std::vector<rejected_candidate> result;
    for (const auto& x : found_.rejected) {
      rejected_candidate row{step(x.step).step.id,
                             asked_.nodes[x.node].name,
                             deployment(x.step, x.deployment),
                             {}};
      const auto gpu =
          x.gpu < 0 ? std::string{} : "GPU " + std::to_string(x.gpu) + ": ";
      for (const auto& reason : x.reasons)
        row.reasons.push_back(
            (reason.kind == allocation::reason_kind::gpu_memory ? gpu : "")
            + reason.text);
      result.push_back(std::move(row));
    }
    return result;
  }

private:
  const resolved_step& step(size_t i) const {
    return asked_.steps[i];
  }

  std::string deployment(size_t step_index, size_t i) const {
    return step(step_index).model.deployments[i].name;
  }

  step_allocation describe(const allocation::placement& x) const {
    return {step(x.step).step.id,
            asked_.nodes[x.node].name,
            deployment(x.step, x.deployment),
            x.gpu,
            {x.shares.cpu, x.shares.memory, x.shares.disk,
             x.shares.gpu_memory.value_or(-1)},
            x.variance,
            x.bonus};
  }

  const allocate_task& asked_;
  const allocation::result& found_;
};

failure refusal(const allocate_task& asked, const allocation::result& found) {
  using allocation::outcome;
  if (found.what == outcome::invalid)
    return {error_code::schema_violation, found.message, "",
            "every resource is a finite number that is not negative"};
  if (found.what == outcome::undecided)
    return {error_code::timeout, found.message, "/pipeline",
            "ask for fewer steps at once, or name the deployments"};
  failure result{error_code::no_feasible_allocation, found.message, "/pipeline",
                 "`rejected` says for each candidate what is in the way"};
  result.details =
      json{{"rejected", plan_writer{asked, found}.rejected()}}.dump();
  return result;
}

} // namespace

std::variant<task_plan, failure> allocate(const allocate_task& asked,
                                          std::chrono::milliseconds budget) {
  allocation::limits limits;
  limits.budget = budget;
  const auto found = allocation::allocate(convert(asked), limits);
  if (!found.has_allocation())
    return refusal(asked, found);
  return plan_writer{asked, found}.plan();
}

std::variant<task_plan, failure>
allocate_offline(const plan_document& document) {
  std::vector<skill_row> skills;
  for (const auto& descriptor : document.skills) {
    skill_row row{{"", descriptor}, {}};
    for (const auto& node : document.nodes)
      row.nodes.push_back(node.name);
    skills.push_back(std::move(row));
  }
  auto steps =
      resolve_steps(document.request.pipeline, skills, "/request/pipeline");
  if (auto* problem = std::get_if<failure>(&steps))
    return std::move(*problem);
  return allocate({document.request.task,
                   std::get<std::vector<resolved_step>>(std::move(steps)),
                   document.nodes},
                  offline_allocation_budget);
}

} // namespace roscell
