#include "actors/placement/questions/task_allocation.hpp"

#include "actors/placement/questions/search_problem.hpp"
#include "actors/placement/reading/step_copies.hpp"
#include "actors/placement/reading/task_reading.hpp"
#include "actors/placement/search/allocation.hpp"
#include "actors/placement/search/report/explain.hpp"
#include "actors/placement/search/running/eviction.hpp"

#include <algorithm>
#include <optional>
#include <utility>

namespace roscell {

namespace {

/// A label or a skill is no amount of which anything could be short.
rejection_cause cause_of(const allocation::reason& why) {
  rejection_cause result{allocation::to_string(why.kind)};
  if (why.short_by <= 0)
    return result;
  result.needed = why.needed;
  result.free = std::max(0.0, why.free);
  result.short_by = why.short_by;
  return result;
}

void add_exclusion(const allocate_task& asked,
                   const std::vector<step_ways>& ways,
                   const excluded_candidate& x, allocation::problem& to) {
  const auto step = step_position(asked.steps, x.step);
  if (step == asked.steps.size())
    return;
  to.excluded.push_back({step, node_position(asked.nodes, x.node),
                         ways[step].find(x.deployment, x.node), x.gpu, x.reason,
                         x.cpu_floor});
}

allocation::problem make_problem(const allocate_task& asked,
                                 const std::vector<step_ways>& ways) {
  auto result = make_problem(asked.nodes, ways);
  for (const auto& x : asked.excluded)
    add_exclusion(asked, ways, x, result);
  return result;
}

constexpr double bytes_of_mib = 1024 * 1024;

/// Puts names where the search speaks of positions.
class plan_writer {
public:
  plan_writer(const allocate_task& asked, const std::vector<step_ways>& ways,
              const allocation::result& found,
              double alpha = allocation::problem{}.alpha)
      : asked_(asked), ways_(ways), found_(found), alpha_(alpha) {}

  task_plan plan() const {
    task_plan result;
    result.task = asked_.task;
    result.optimal = found_.optimal();
    result.score = score();
    result.allocations = allocations();
    result.rejected = rejected();
    result.warnings = found_.warnings;
    result.states = static_cast<int64_t>(found_.expanded);
    return result;
  }

  allocation_score score() const {
    const auto& value = found_.value;
    return {
        value.total,        value.balance,
        value.load,         alpha_,
        found_.lower_bound, std::max(0.0, value.total - found_.lower_bound)};
  }

  std::vector<step_allocation> allocations() const {
    std::vector<step_allocation> result;
    for (const auto& x : found_.placements)
      result.push_back(describe(x));
    return result;
  }

  std::vector<rejected_candidate> rejected() const {
    std::vector<rejected_candidate> result;
    for (const auto& x : found_.rejected) {
      rejected_candidate row{step(x.step).step.id,
                             asked_.nodes[x.node].name,
                             ways_[x.step].name(x.deployment),
                             {},
                             {},
                             x.gpu};
      const auto gpu =
          x.gpu < 0 ? std::string{} : "GPU " + std::to_string(x.gpu) + ": ";
      for (const auto& reason : x.reasons) {
        row.reasons.push_back(
            (reason.kind == allocation::reason_kind::gpu_memory ? gpu : "")
            + reason.text);
        row.causes.push_back(cause_of(reason));
      }
      // A node without the skill lacks each way of it that has this name.
      if (std::find(result.begin(), result.end(), row) == result.end())
        result.push_back(std::move(row));
    }
    return result;
  }

private:
  const resolved_step& step(size_t i) const {
    return asked_.steps[i];
  }

  step_allocation describe(const allocation::placement& x) const {
    const auto& ways = ways_[x.step];
    const auto& node = asked_.nodes[x.node].name;
    return {step(x.step).step.id,
            node,
            ways.name(x.deployment),
            x.gpu,
            {x.shares.cpu, x.shares.memory, x.shares.disk,
             x.shares.gpu_memory.value_or(-1)},
            x.variance,
            x.bonus,
            ways.build(x.deployment, node),
            static_cast<double>(bytes_to_fetch(
                step(x.step), ways.build(x.deployment, node), node))
                / bytes_of_mib};
  }

  const allocate_task& asked_;
  const std::vector<step_ways>& ways_;
  const allocation::result& found_;
  double alpha_;
};

constexpr const char* busy_cores =
    "other programs keep the cores busy: what they use counts up to each "
    "node's --cpu-floor only";

std::vector<resource_use> uses_in(const allocate_task& asked,
                                  const allocation::problem& problem,
                                  const allocation::result& found) {
  std::vector<resource_use> result;
  for (const auto& x : allocation::uses(problem, found.placements))
    result.push_back(
        {asked.nodes[x.node].name, x.name, x.capacity, x.before, x.after});
  return result;
}

step_alternative alternative_to(const allocate_task& asked,
                                const std::vector<step_ways>& ways,
                                const allocation::problem& problem,
                                const allocation::result& chosen, size_t step,
                                const allocation::limits& limits) {
  const auto other = allocation::alternative(problem, chosen, step, limits);
  const plan_writer writer{asked, ways, other, problem.alpha};
  step_alternative result;
  result.step = asked.steps[step].step.id;
  result.optimal = other.optimal() && chosen.optimal();
  if (!other.has_allocation()) {
    result.obstacle = other.message;
    return result;
  }
  result.extra = other.value.total - chosen.value.total;
  result.score = writer.score();
  result.allocations = writer.allocations();
  return result;
}

void add_eviction(const task_eviction& way, task_plan& plan) {
  plan.preempted = way.preempted;
  if (!way.optimal)
    plan.warnings.emplace_back(
        "the search for what to preempt was stopped: less may do");
}

failure refusal(const allocate_task& asked, const std::vector<step_ways>& ways,
                const allocation::result& found) {
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
      json{{"rejected", plan_writer{asked, ways, found}.rejected()}}.dump();
  return result;
}

} // namespace

std::variant<task_plan, failure>
allocate(const allocate_task& question, std::chrono::milliseconds budget,
         const std::function<bool()>& cancelled) {
  auto asked = question;
  asked.nodes = in_order_of_fetching(std::move(asked.nodes), asked.steps);
  const auto why = step_position(asked.steps, asked.why);
  if (!asked.why.empty() && why == asked.steps.size())
    return failure{error_code::schema_violation,
                   "there is no step '" + asked.why + "'", "/why",
                   "name the id of a step of the pipeline"};
  allocation::limits limits;
  limits.budget = budget;
  limits.cancelled = cancelled;
  const auto ways = ways_of(asked.steps);
  auto problem = make_problem(asked, ways);
  auto made = allocation::allocate_with_floor(problem, limits);
  std::optional<task_eviction> way;
  if (made.found.what == allocation::outcome::infeasible)
    way = evict_for(asked, problem, limits);
  if (way) {
    problem = way->problem;
    made = allocation::allocate_with_floor(problem, limits);
  }
  if (!made.found.has_allocation())
    return refusal(asked, ways, made.found);
  auto plan = plan_writer{asked, ways, made.found, problem.alpha}.plan();
  if (way)
    add_eviction(*way, plan);
  if ((plan.cpu_floor = made.cpu_floor))
    plan.warnings.emplace_back(busy_cores);
  // As it is, however the CPU was read.
  plan.use = uses_in(asked, problem, made.found);
  if (!asked.why.empty())
    plan.alternatives = {
        alternative_to(asked, ways, made.read, made.found, why, limits)};
  return plan;
}

std::variant<task_plan, failure> allocate_offline(const plan_document& document,
                                                  const std::string& why) {
  skill_list known;
  for (const auto& descriptor : document.skills) {
    skill_row row;
    row.skill.descriptor = descriptor;
    for (const auto& node : document.nodes)
      row.nodes.push_back(node.name);
    known.skills.push_back(std::move(row));
  }
  auto steps = with_copies(document.request.pipeline, "/request/pipeline");
  if (auto* problem = std::get_if<failure>(&steps))
    return std::move(*problem);
  auto reading =
      read_task(document.request.task, std::get<std::vector<task_step>>(steps),
                {known, {}, {}}, "/request/pipeline");
  if (auto* problem = std::get_if<failure>(&reading))
    return std::move(*problem);
  auto& meant = std::get<task_reading>(reading);
  allocate_task asked{
      document.request.task, std::move(meant.steps), document.nodes, {}, why};
  // The numbers on paper are meant as they stand.
  for (auto& node : asked.nodes)
    node.cpu_compressible = 0;
  auto made = allocate(asked, limits::task::offline_allocation_budget);
  if (auto* plan = std::get_if<task_plan>(&made))
    plan->warnings.insert(plan->warnings.begin(), meant.warnings.begin(),
                          meant.warnings.end());
  return made;
}

namespace {

int64_t least_priority(const allocate_task& asked) {
  int64_t result = allocation::priorities;
  for (const auto& x : asked.steps)
    result = std::min(result, x.step.priority);
  return result;
}

allocation::holder holder_of(const evictable_instance& x, size_t node) {
  return {node,
          static_cast<int>(x.who.priority),
          x.resources.cpu,
          x.resources.memory_mib,
          x.resources.disk_mib,
          std::max(0.0, x.resources.gpu_memory_mib),
          x.gpu};
}

} // namespace

std::optional<task_eviction> evict_for(const allocate_task& asked,
                                       const allocation::problem& problem,
                                       const allocation::limits& limits) {
  const auto floor = least_priority(asked);
  std::vector<allocation::holder> holders;
  std::vector<preempted_instance> who;
  for (const auto& x : asked.evictable) {
    const auto node = node_position(asked.nodes, x.who.node);
    if (node == asked.nodes.size() || x.who.priority >= floor
        || x.who.priority < 0)
      continue;
    holders.push_back(holder_of(x, node));
    who.push_back(x.who);
  }
  // The reading of the CPU with which the least has to go.
  const auto found = allocation::find_eviction(
      allocation::read_with_floor(problem), holders, limits);
  if (found.holders.empty())
    return std::nullopt;
  task_eviction result;
  result.problem = allocation::without(problem, holders, found.holders);
  result.optimal = found.what == allocation::outcome::optimal;
  for (const auto i : found.holders)
    result.preempted.push_back(who[i]);
  return result;
}

} // namespace roscell
