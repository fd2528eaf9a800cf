#include "actors/placement/search/groups.hpp"

#include <algorithm>
#include <map>
#include <numeric>

namespace roscell::allocation {

namespace {

std::vector<std::vector<std::uint32_t>> kinds_of(const search_space& space) {
  const auto& twins = space.candidates.twins;
  std::vector<std::vector<std::uint32_t>> kinds;
  std::vector<std::size_t> kind(twins.size());
  for (std::uint32_t v = 0; v < twins.size(); ++v) {
    kind[v] =
        twins[v] < 0 ? kinds.size() : kind[static_cast<std::size_t>(twins[v])];
    if (kind[v] == kinds.size())
      kinds.emplace_back();
    kinds[kind[v]].push_back(v);
  }
  return kinds;
}

class group_finder {
public:
  group_finder(const search_space& space, const std::vector<double>& least_cost,
               double most_total, std::size_t most_groups, watch& until)
      : space_(space), least_cost_(least_cost), most_groups_(most_groups),
        until_(until), now_(space.empty) {
    auto least = std::accumulate(least_cost.begin(), least_cost.end(), 0.0);
    most_extra_ = most_total * static_cast<double>(space.steps()) - least;
    found_.kinds = kinds_of(space);
    unite_steps();
  }

  std::optional<group_list> run() {
    for (std::uint32_t kind = 0; kind < found_.kinds.size(); ++kind) {
      grown_ = {};
      grown_.kind = kind;
      node_ = found_.kinds[kind].front();
      if (!grow(0, 0))
        return std::nullopt;
    }
    return std::move(found_);
  }

private:
  /// The steps that must share a node, as sets.
  void unite_steps() {
    std::map<std::size_t, step_set> united;
    for (std::size_t i = 0; i < space_.steps(); ++i)
      if (const auto number = space_.asked.steps[i].together; number != 0)
        united[number] |= step_set{1} << i;
    for (const auto& [number, steps] : united)
      united_.push_back(steps);
  }

  bool splits_united() const {
    return std::any_of(united_.begin(), united_.end(), [&](step_set steps) {
      const auto here = grown_.steps & steps;
      return here != 0 && here != steps;
    });
  }

  /// Adds each step from `first` on to the group in each way that fits.
  /// `extra` is what the group costs above the least cost of its steps, which
  /// the total cannot make good elsewhere. False ends it all.
  bool grow(std::size_t first, double extra) {
    for (auto i = first; i < space_.steps(); ++i) {
      const auto& from = space_.candidates.from[i];
      for (auto c = from[node_]; c < from[node_ + 1]; ++c)
        if (!try_way(i, c, extra))
          return false;
    }
    return true;
  }

  bool try_way(std::size_t i, std::uint32_t c, double extra) {
    const auto& choice = space_.choice(i, c);
    const auto& way = space_.way(i, choice);
    auto all = now_.shares_of(way, choice);
    if (!all.fit() || repeats(i, c, all))
      return true;
    auto cost = space_.cost(i, choice, all);
    extra += cost - least_cost_[i];
    if (extra > most_extra_)
      return true;
    if (found_.of.size() == most_groups_ || until_.must_stop())
      return false;
    auto before = now_.place(way, choice);
    auto shorter = grown_;
    grown_.steps |= step_set{1} << i;
    grown_.cost += cost;
    chosen_.push_back(c - space_.candidates.from[i][node_]);
    keep();
    bool goes_on = grow(i + 1, extra);
    chosen_.pop_back();
    grown_ = shorter;
    now_.restore(choice, before);
    return goes_on;
  }

  /// Whether an earlier GPU has as much memory free, and so does as well: its
  /// free memory is all that a GPU is to the steps to come. On unified memory
  /// this holds for any two.
  bool repeats(std::size_t i, std::uint32_t c, const shares& all) const {
    const auto& choice = space_.choice(i, c);
    for (auto e = space_.candidates.from[i][node_]; e < c; ++e) {
      const auto& earlier = space_.choice(i, e);
      if (choice.gpu < 0 || earlier.deployment != choice.deployment)
        continue;
      auto other = now_.shares_of(space_.way(i, earlier), earlier);
      if (other.of[gpu_memory].free == all.of[gpu_memory].free)
        return true;
    }
    return false;
  }

  void keep() {
    if (splits_united())
      return;
    grown_.load = now_.load(node_);
    grown_.ways = static_cast<std::uint32_t>(found_.ways.size());
    found_.ways.insert(found_.ways.end(), chosen_.begin(), chosen_.end());
    found_.of.push_back(grown_);
  }

  const search_space& space_;
  const std::vector<double>& least_cost_;
  std::size_t most_groups_;
  watch& until_;
  occupancy now_;
  double most_extra_;
  std::vector<step_set> united_;
  group_list found_;
  group grown_;
  std::vector<std::uint32_t> chosen_;
  std::uint32_t node_ = 0;
};

} // namespace

std::optional<group_list> find_groups(const search_space& space,
                                      const std::vector<double>& least_cost,
                                      double most_total,
                                      std::size_t most_groups, watch& until) {
  return group_finder(space, least_cost, most_total, most_groups, until).run();
}

} // namespace roscell::allocation
