#include "actors/placement/search/search.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <tuple>

namespace roscell::allocation {

namespace {

using amounts = std::array<double, resource_count>;

/// Effort per step to make a conflict smaller: milliseconds.
constexpr std::size_t conflict_branches = 20'000;

amounts taken_by(const search_space& space, std::size_t step,
                 const candidate& choice) {
  const auto& way = space.way(step, choice);
  if (space.asked.nodes[choice.node].unified_memory)
    return {way.cpu, way.memory_mib + way.gpu_memory_mib, way.disk_mib, 0};
  return {way.cpu, way.memory_mib, way.disk_mib, way.gpu_memory_mib};
}

double left_of(const amount& of) {
  return std::max(0.0, of.capacity - of.used);
}

class fitter {
public:
  fitter(const search_space& space, std::vector<std::size_t> steps,
         std::size_t most_branches, watch& until)
      : space_(space), order_(std::move(steps)), left_(most_branches),
        until_(until), now_(space.empty) {
    sort_steps();
    sum_up_least();
    sum_up_free();
  }

  feasibility run() {
    feasibility answer;
    answer.found.assign(space_.steps(), 0);
    answer.what = place_from(0, answer.found);
    return answer;
  }

private:
  /// Equal steps become neighbours with the same class; those with the fewest
  /// candidates come first.
  void sort_steps() {
    using candidate_look =
        std::tuple<std::uint32_t, std::int32_t, double, double, double, double>;
    using look = std::pair<std::size_t, std::vector<candidate_look>>;
    std::map<look, std::size_t> classes;
    class_.resize(space_.steps());
    for (auto i : order_) {
      look seen{space_.asked.steps[i].together, {}};
      for (const auto& choice : space_.candidates.of[i]) {
        const auto& way = space_.way(i, choice);
        seen.second.emplace_back(choice.node, choice.gpu, way.cpu,
                                 way.memory_mib, way.disk_mib,
                                 way.gpu_memory_mib);
      }
      class_[i] = classes.try_emplace(seen, classes.size()).first->second;
    }
    auto hardness = [this](std::size_t i) {
      return std::tuple(space_.candidates.of[i].size(), class_[i], i);
    };
    std::sort(order_.begin(), order_.end(), [&](auto left, auto right) {
      return hardness(left) < hardness(right);
    });
  }

  /// least_[p]: what the steps from the p-th on take together at least.
  void sum_up_least() {
    least_.assign(order_.size() + 1, amounts{});
    for (auto p = order_.size(); p-- > 0;) {
      const auto& list = space_.candidates.of[order_[p]];
      auto least =
          list.empty() ? amounts{} : taken_by(space_, order_[p], list.front());
      for (const auto& choice : list) {
        auto takes = taken_by(space_, order_[p], choice);
        for (std::size_t r = 0; r < resource_count; ++r)
          least[r] = std::min(least[r], takes[r]);
      }
      for (std::size_t r = 0; r < resource_count; ++r)
        least_[p][r] = least_[p + 1][r] + least[r];
    }
  }

  /// What is free on the nodes that any of the steps can use. Each amount may
  /// be overdrawn by the tolerance.
  void sum_up_free() {
    for (std::size_t v = 0; v < space_.asked.nodes.size(); ++v) {
      if (std::none_of(order_.begin(), order_.end(), [&](std::size_t i) {
            return space_.candidates.from[i][v]
                   < space_.candidates.from[i][v + 1];
          }))
        continue;
      const auto& node = space_.asked.nodes[v];
      free_[cpu] += left_of(node.cpu) + tolerance;
      free_[memory] += left_of(node.memory_mib) + tolerance;
      free_[disk] += left_of(node.disk_mib) + tolerance;
      for (const auto& card : node.gpus)
        free_[gpu_memory] += left_of(card.memory_mib) + tolerance;
    }
  }

  bool enough_for(std::size_t position) const {
    for (std::size_t r = 0; r < resource_count; ++r)
      if (least_[position][r] > free_[r] * (1 + 1e-12))
        return false;
    return true;
  }

  /// Equal steps take their candidates in order, since swapping two of them
  /// changes nothing.
  std::size_t first_choice(std::size_t position, const assignment& found) {
    if (position == 0
        || class_[order_[position]] != class_[order_[position - 1]])
      return 0;
    return found[order_[position - 1]];
  }

  /// As `search_space::is_apart`, in the order of this search.
  bool is_apart(std::size_t position, const candidate& at,
                const assignment& found) const {
    const auto group = space_.asked.steps[order_[position]].together;
    if (group == 0)
      return false;
    for (std::size_t p = 0; p < position; ++p)
      if (space_.asked.steps[order_[p]].together == group)
        return space_.choice(order_[p], found[order_[p]]).node != at.node;
    return false;
  }

  verdict place_from(std::size_t position, assignment& found) {
    if (position == order_.size())
      return verdict::fits;
    if (!enough_for(position))
      return verdict::impossible;
    auto step = order_[position];
    const auto& list = space_.candidates.of[step];
    for (auto c = first_choice(position, found); c < list.size(); ++c) {
      if (space_.has_idle_twin(list[c], now_)
          || is_apart(position, list[c], found))
        continue;
      auto tried = place_one(position, list[c], found, c);
      if (tried != verdict::impossible)
        return tried;
    }
    return verdict::impossible;
  }

  verdict place_one(std::size_t position, const candidate& choice,
                    assignment& found, std::size_t c) {
    auto step = order_[position];
    const auto& way = space_.way(step, choice);
    if (!now_.shares_of(way, choice).fit())
      return verdict::impossible;
    if (left_-- == 0 || until_.must_stop()) {
      left_ = 0;
      return verdict::unknown;
    }
    found[step] = c;
    auto free_before = free_;
    auto takes = taken_by(space_, step, choice);
    for (std::size_t r = 0; r < resource_count; ++r)
      free_[r] -= takes[r];
    auto before = now_.place(way, choice);
    auto tried = place_from(position + 1, found);
    now_.restore(choice, before);
    free_ = free_before;
    return tried;
  }

  const search_space& space_;
  std::vector<std::size_t> order_;
  std::size_t left_;
  watch& until_;
  occupancy now_;
  std::vector<std::size_t> class_;
  std::vector<amounts> least_;
  amounts free_{};
};

/// All but one of them and those that it must share a node with: which nodes
/// these can use depends on each other.
std::vector<std::size_t> without(const search_space& space,
                                 std::vector<std::size_t> steps,
                                 std::size_t left_out) {
  const auto group = space.asked.steps[left_out].together;
  steps.erase(std::remove_if(steps.begin(), steps.end(),
                             [&](std::size_t i) {
                               return i == left_out
                                      || (group != 0
                                          && space.asked.steps[i].together
                                                 == group);
                             }),
              steps.end());
  return steps;
}

} // namespace

feasibility find_fit(const search_space& space,
                     const std::vector<std::size_t>& steps,
                     std::size_t most_branches, watch& until) {
  return fitter(space, steps, most_branches, until).run();
}

std::vector<std::size_t> smallest_conflict(const search_space& space,
                                           std::vector<std::size_t> steps,
                                           watch& until) {
  for (std::size_t i = 0; i < steps.size();) {
    auto others = without(space, steps, steps[i]);
    auto tried = find_fit(space, others, conflict_branches, until);
    if (tried.what == verdict::impossible)
      steps = std::move(others);
    else
      ++i;
  }
  return steps;
}

} // namespace roscell::allocation
