#include "actors/placement/questions/task_allocation.hpp"

#include "actors/placement/questions/search_problem.hpp"
#include "actors/placement/search/running/better_moves.hpp"

#include <algorithm>
#include <utility>

namespace roscell {

namespace {

using allocation::seat;

/// Steps with one id each, on nodes in whose use they do not count.
struct moving_problem {
  std::vector<running_step> steps;
  std::vector<resolved_step> resolved;
  std::vector<step_ways> ways;
  allocation::problem problem;
  std::vector<seat> seats;
};

/// What all steps hold of one resource leaves its use. What others use may be
/// more than is left for them: then the node is full, and no more.
void leave(allocation::amount& of, double held) {
  of.used = std::clamp(of.used - held, 0.0, std::max(0.0, of.capacity - held));
}

void leave(allocation::node& host, const std::vector<running_step>& steps) {
  resource_request sum{0, 0, 0, 0};
  std::map<int, double> cards;
  for (const auto& x : steps) {
    if (x.node != host.name)
      continue;
    const auto& r = x.resources;
    const auto gpu_memory = std::max(0.0, r.gpu_memory_mib);
    sum.cpu += r.cpu;
    sum.memory_mib += r.memory_mib + (host.unified_memory ? gpu_memory : 0);
    sum.disk_mib += r.disk_mib;
    cards[x.gpu] += gpu_memory;
  }
  leave(host.cpu, sum.cpu);
  leave(host.memory_mib, sum.memory_mib);
  leave(host.disk_mib, sum.disk_mib);
  if (!host.unified_memory)
    for (auto& card : host.gpus)
      leave(card.memory_mib, cards[card.index]);
}

moving_problem make(const plan_moves& asked, std::vector<running_step> steps) {
  moving_problem result;
  result.steps = std::move(steps);
  for (size_t i = 0; i < result.steps.size(); ++i) {
    result.resolved.push_back(result.steps[i].step);
    // Unique, for the search.
    result.resolved.back().step.id += "." + std::to_string(i);
  }
  result.ways = ways_of(result.resolved);
  result.problem = make_problem(asked.nodes, result.ways);
  for (auto& host : result.problem.nodes) {
    leave(host, result.steps);
    host.cpu_compressible = 0;
  }
  for (size_t i = 0; i < result.steps.size(); ++i) {
    const auto& x = result.steps[i];
    result.seats.push_back({node_position(asked.nodes, x.node),
                            result.ways[i].find(x.deployment, x.node), x.gpu});
  }
  return result;
}

/// Without the steps that could not be placed where they run.
moving_problem movable(const plan_moves& asked) {
  auto result = make(asked, asked.steps);
  const auto fixed = allocation::misplaced(result.problem, result.seats);
  if (fixed.empty())
    return result;
  std::vector<running_step> kept;
  for (size_t i = 0; i < asked.steps.size(); ++i)
    if (!std::binary_search(fixed.begin(), fixed.end(), i))
      kept.push_back(asked.steps[i]);
  return make(asked, std::move(kept));
}

rebalance_move describe(const plan_moves& asked, const moving_problem& known,
                        const allocation::step_move& x) {
  const auto& step = known.steps[x.step];
  rebalance_move result;
  result.instance = step.instance;
  result.task = step.task;
  result.step = step.step.step.id;
  result.from = step.node;
  result.to = asked.nodes[x.to.node].name;
  result.gain = x.gain;
  return result;
}

} // namespace

std::variant<moves_planned, failure>
plan_better_moves(const plan_moves& asked, std::chrono::milliseconds budget,
                  const std::function<bool()>& cancelled) {
  const auto known = movable(asked);
  if (known.steps.empty())
    return moves_planned{0, 0, 0, true, {}};
  allocation::limits limits;
  limits.budget = budget;
  limits.cancelled = cancelled;
  const auto found = allocation::better_moves(
      known.problem, known.seats,
      {asked.min_gain, static_cast<size_t>(asked.most_moves)}, limits);
  if (!found.message.empty())
    return failure{error_code::conflict, found.message, "",
                   "`roscell nodes` shows which node is too full"};
  moves_planned result{found.before.total,
                       found.after.total,
                       found.lower_bound,
                       found.optimal,
                       {}};
  for (const auto& x : found.moves)
    result.moves.push_back(describe(asked, known, x));
  return result;
}

} // namespace roscell
