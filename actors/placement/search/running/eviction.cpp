#include "actors/placement/search/running/eviction.hpp"

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/candidates.hpp"
#include "actors/placement/search/running/preemption_search.hpp"

#include <algorithm>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace roscell::allocation {

namespace {

std::vector<std::size_t> all_of(const std::vector<holder>& holders) {
  std::vector<std::size_t> result(holders.size());
  std::iota(result.begin(), result.end(), 0);
  return result;
}

void give_back(amount& of, double given) {
  of.used = std::max(0.0, of.used - given);
}

/// Depth-first branch and bound over the steps, those first that need the most
/// to go. What each node must give up for the steps on it is found exactly, and
/// never gets cheaper when a step is added.
class eviction_search {
public:
  eviction_search(const problem& asked, const std::vector<holder>& holders,
                  const limits& bounds)
      : asked_(asked), empty_(without(asked, holders, all_of(holders))),
        found_(find_candidates(empty_, rejected_)), until_(bounds) {
    for (std::size_t v = 0; v < asked.nodes.size(); ++v) {
      makers_.emplace_back(asked, v);
      demand_.emplace_back();
      price_.emplace_back();
      steps_on_.push_back(0);
    }
    for (std::size_t i = 0; i < holders.size(); ++i)
      makers_[holders[i].node].add(i, holders[i]);
    for (auto& x : makers_)
      x.sort();
    sort_steps();
  }

  eviction run() {
    if (std::any_of(found_.of.begin(), found_.of.end(),
                    [](const auto& list) { return list.empty(); }))
      return {};
    chosen_.resize(asked_.steps.size());
    visit(0);
    eviction result;
    if (!best_) {
      result.what = until_.stopped() ? outcome::undecided : outcome::infeasible;
      return result;
    }
    result.what = until_.stopped() ? outcome::best_found : outcome::optimal;
    result.holders = std::move(gone_);
    std::sort(result.holders.begin(), result.holders.end());
    return result;
  }

private:
  struct branch {
    price total;
    std::size_t position; ///< Among the step's candidates.
  };

  const deployment& way_of(std::size_t step, const candidate& choice) const {
    return asked_.steps[step].deployments[choice.deployment];
  }

  /// The least that a step costs where it is alone; none if it has no place.
  std::optional<price> price_alone(std::size_t step) {
    std::optional<price> least;
    for (const auto& choice : found_.of[step]) {
      auto& maker = makers_[choice.node];
      const auto& needed =
          maker.cover_of(maker.demand_of(way_of(step, choice), choice));
      if (needed && (!least || needed->cost < *least))
        least = needed->cost;
    }
    return least;
  }

  void sort_steps() {
    std::vector<std::pair<price, std::size_t>> keys;
    for (std::size_t i = 0; i < asked_.steps.size(); ++i)
      keys.emplace_back(price_alone(i).value_or(price{}), i);
    std::sort(keys.begin(), keys.end(), [this](const auto& x, const auto& y) {
      if (y.first < x.first || x.first < y.first)
        return y.first < x.first;
      const auto xs = found_.of[x.second].size();
      const auto ys = found_.of[y.second].size();
      return std::tie(xs, x.second) < std::tie(ys, y.second);
    });
    for (const auto& [least, step] : keys) {
      order_.push_back(step);
      least_.push_back(least);
    }
  }

  /// Steps that share files are on one node.
  bool is_apart(std::size_t depth, const candidate& at) const {
    const auto group = asked_.steps[order_[depth]].together;
    if (group == 0)
      return false;
    for (std::size_t i = 0; i < depth; ++i)
      if (asked_.steps[order_[i]].together == group
          && found_.of[order_[i]][chosen_[order_[i]]].node != at.node)
        return true;
    return false;
  }

  /// Of nodes that are alike and idle, with nothing to give up, one will do.
  bool has_idle_twin(const candidate& at) const {
    const auto twin = found_.twins[at.node];
    if (twin < 0 || steps_on_[at.node] > 0 || !makers_[at.node].is_empty())
      return false;
    const auto other = static_cast<std::size_t>(twin);
    return steps_on_[other] == 0 && makers_[other].is_empty();
  }

  amounts demand_with(std::size_t step, const candidate& at) const {
    auto result = makers_[at.node].demand_of(way_of(step, at), at);
    for (std::size_t r = 0; r < demand_[at.node].size(); ++r)
      result[r] += demand_[at.node][r];
    return result;
  }

  bool is_late(const price& total, std::size_t depth) const {
    if (!best_)
      return false;
    if (!(total < *best_))
      return true;
    // The steps come with the dearest first, so it bounds all that follow.
    return depth + 1 < order_.size() && !(least_[depth + 1] < *best_);
  }

  std::vector<branch> branches(std::size_t depth) {
    const auto step = order_[depth];
    std::vector<branch> result;
    const auto& list = found_.of[step];
    for (std::size_t c = 0; c < list.size(); ++c) {
      const auto& at = list[c];
      if (is_apart(depth, at) || has_idle_twin(at))
        continue;
      const auto& needed = makers_[at.node].cover_of(demand_with(step, at));
      if (!needed)
        continue;
      auto total = total_;
      total -= price_[at.node];
      total += needed->cost;
      if (!is_late(total, depth))
        result.push_back({total, c});
    }
    std::stable_sort(
        result.begin(), result.end(),
        [](const auto& x, const auto& y) { return x.total < y.total; });
    return result;
  }

  void visit(std::size_t depth) {
    if (depth == order_.size())
      return reach_end();
    const auto step = order_[depth];
    for (const auto& x : branches(depth)) {
      if (until_.must_stop())
        return;
      if (is_late(x.total, depth))
        continue;
      const auto& at = found_.of[step][x.position];
      const auto demand = demand_[at.node];
      const auto price = price_[at.node];
      const auto total = total_;
      chosen_[step] = x.position;
      demand_[at.node] = demand_with(step, at);
      price_[at.node] = makers_[at.node].cover_of(demand_[at.node])->cost;
      total_ = x.total;
      ++steps_on_[at.node];
      visit(depth + 1);
      --steps_on_[at.node];
      demand_[at.node] = demand;
      price_[at.node] = price;
      total_ = total;
    }
  }

  void reach_end() {
    if (best_ && !(total_ < *best_))
      return;
    best_ = total_;
    gone_.clear();
    for (std::size_t v = 0; v < makers_.size(); ++v)
      if (steps_on_[v] > 0) {
        const auto& here = makers_[v].cover_of(demand_[v])->holders;
        gone_.insert(gone_.end(), here.begin(), here.end());
      }
  }

  const problem& asked_;
  problem empty_; ///< Without any holder.
  std::vector<rejected_candidate> rejected_;
  candidate_set found_;
  watch until_;
  std::vector<preemption_search> makers_; ///< Per node.
  std::vector<amounts> demand_; ///< The same, of the steps placed so far.
  std::vector<price> price_;    ///< The same, of these.
  std::vector<std::size_t> steps_on_;
  std::vector<std::size_t> order_;  ///< Of the steps.
  std::vector<price> least_;        ///< Alone, in that order.
  std::vector<std::size_t> chosen_; ///< Per step, in the problem's order.
  price total_;
  std::optional<price> best_;
  std::vector<std::size_t> gone_;
};

} // namespace

eviction find_eviction(const problem& asked, const std::vector<holder>& holders,
                       const limits& bounds) {
  return eviction_search(asked, holders, bounds).run();
}

problem without(problem asked, const std::vector<holder>& holders,
                const std::vector<std::size_t>& gone) {
  for (const auto i : gone) {
    const auto& x = holders[i];
    auto& host = asked.nodes[x.node];
    give_back(host.cpu, x.cpu);
    give_back(host.memory_mib,
              x.memory_mib + (host.unified_memory ? x.gpu_memory_mib : 0));
    give_back(host.disk_mib, x.disk_mib);
    if (!host.unified_memory)
      for (auto& card : host.gpus)
        if (card.index == x.gpu)
          give_back(card.memory_mib, x.gpu_memory_mib);
  }
  return asked;
}

} // namespace roscell::allocation
