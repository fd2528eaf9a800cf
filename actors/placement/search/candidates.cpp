#include "actors/placement/search/candidates.hpp"

#include "actors/placement/search/report/text.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace roscell::allocation {

namespace {

/// Positions of the node's GPUs, by index.
std::vector<std::int32_t> gpus_in_order(const node& host) {
  std::vector<std::int32_t> order(host.gpus.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](auto left, auto right) {
    return host.gpus[left].index < host.gpus[right].index;
  });
  return order;
}

class candidate_finder {
public:
  candidate_finder(const problem& asked,
                   std::vector<rejected_candidate>& rejected)
      : asked_(asked), empty_(asked), rejected_(rejected) {}

  candidate_set run() {
    candidate_set found;
    for (std::size_t i = 0; i < asked_.steps.size(); ++i) {
      found.of.emplace_back();
      found.from.emplace_back();
      for (std::uint32_t v = 0; v < asked_.nodes.size(); ++v) {
        found.from[i].push_back(size(found.of[i]));
        try_node(i, v, found.of[i]);
      }
      found.from[i].push_back(size(found.of[i]));
    }
    const auto alone = found;
    for (std::size_t i = 0; i < asked_.steps.size(); ++i)
      if (asked_.steps[i].together != 0)
        leave_lonely_nodes(i, alone, found);
    return found;
  }

private:
  static std::uint32_t size(const std::vector<candidate>& list) {
    return static_cast<std::uint32_t>(list.size());
  }

  void try_node(std::size_t step, std::uint32_t v,
                std::vector<candidate>& usable) {
    const auto& ways = asked_.steps[step].deployments;
    auto order = gpus_in_order(asked_.nodes[v]);
    for (std::uint32_t d = 0; d < ways.size(); ++d) {
      if (has_another_way(step, v, ways[d]))
        continue;
      if (!ways[d].needs_gpu || order.empty())
        try_one(step, {v, d, -1}, usable);
      else
        for (auto slot : order)
          try_one(step, {v, d, slot}, usable);
    }
  }

  /// A step that must share a node cannot use one that another cannot use.
  void leave_lonely_nodes(std::size_t step, const candidate_set& alone,
                          candidate_set& found) {
    auto& kept = found.of[step];
    kept.clear();
    for (std::uint32_t v = 0; v < asked_.nodes.size(); ++v) {
      found.from[step][v] = size(kept);
      const auto* missed = missed_on(step, v, alone);
      for (auto c = alone.from[step][v]; c < alone.from[step][v + 1]; ++c)
        if (const auto& choice = alone.of[step][c]; missed == nullptr)
          kept.push_back(choice);
        else
          rejected_.push_back(
              rejection(asked_, step, choice, {apart(*missed)}));
    }
    found.from[step].back() = size(kept);
  }

  /// A step that must share the node and has no candidate on it; null if none.
  const allocation::step* missed_on(std::size_t step, std::uint32_t v,
                                    const candidate_set& alone) const {
    const auto number = asked_.steps[step].together;
    for (std::size_t i = 0; i < asked_.steps.size(); ++i)
      if (asked_.steps[i].together == number
          && alone.from[i][v] == alone.from[i][v + 1])
        return &asked_.steps[i];
    return nullptr;
  }

  static reason apart(const allocation::step& missed) {
    return {reason_kind::combination, 0, 0, 0,
            "shares files with step " + quoted(missed.id)
                + ", which this node cannot run"};
  }

  bool has_another_way(std::size_t step, std::uint32_t v,
                       const deployment& way) const {
    const auto& name = asked_.nodes[v].name;
    return !way.only_on.empty() && way.only_on.count(name) == 0
           && asked_.steps[step].nodes_with_skill.count(name) > 0;
  }

  void try_one(std::size_t step, const candidate& choice,
               std::vector<candidate>& usable) {
    auto reasons = reasons_against(asked_, empty_, step, choice);
    if (reasons.empty())
      usable.push_back(choice);
    else
      rejected_.push_back(rejection(asked_, step, choice, std::move(reasons)));
  }

  const problem& asked_;
  const occupancy empty_;
  std::vector<rejected_candidate>& rejected_;
};

/// All that tells nodes apart for the search, comparable.
class looks {
public:
  looks(const problem& asked, const candidate_set& candidates, std::size_t v)
      : unified_(asked.nodes[v].unified_memory) {
    const auto& host = asked.nodes[v];
    add(host.cpu);
    add(host.memory_mib);
    add(host.disk_mib);
    for (const auto& card : host.gpus) {
      add(card.memory_mib);
      order_.push_back(card.index);
    }
    for (std::size_t i = 0; i < candidates.of.size(); ++i)
      for (auto c = candidates.from[i][v]; c < candidates.from[i][v + 1]; ++c)
        ways_.emplace_back(i, candidates.of[i][c].deployment,
                           candidates.of[i][c].gpu);
  }

  bool operator<(const looks& other) const {
    return std::tie(unified_, numbers_, order_, ways_) < std::tie(
               other.unified_, other.numbers_, other.order_, other.ways_);
  }

private:
  void add(const amount& given) {
    numbers_.push_back(given.capacity);
    numbers_.push_back(given.used);
  }

  bool unified_;
  std::vector<double> numbers_;
  std::vector<int> order_;
  std::vector<std::tuple<std::size_t, std::uint32_t, std::int32_t>> ways_;
};

std::vector<std::ptrdiff_t> find_twins(const problem& asked,
                                       const candidate_set& candidates) {
  std::vector<std::ptrdiff_t> twins;
  std::map<looks, std::ptrdiff_t> last;
  for (std::size_t v = 0; v < asked.nodes.size(); ++v) {
    auto here = static_cast<std::ptrdiff_t>(v);
    auto [known, added] = last.try_emplace(looks(asked, candidates, v), here);
    twins.push_back(added ? -1 : known->second);
    known->second = here;
  }
  return twins;
}

} // namespace

candidate_set find_candidates(const problem& asked,
                              std::vector<rejected_candidate>& rejected) {
  auto found = candidate_finder(asked, rejected).run();
  std::stable_sort(rejected.begin(), rejected.end(),
                   [](const auto& left, const auto& right) {
                     return std::tie(left.step, left.node)
                            < std::tie(right.step, right.node);
                   });
  found.twins = find_twins(asked, found);
  return found;
}

} // namespace roscell::allocation
