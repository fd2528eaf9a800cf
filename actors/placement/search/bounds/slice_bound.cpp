#include "actors/placement/search/bounds/slice_bound.hpp"

#include <algorithm>

namespace roscell::allocation {

namespace {

double distance(double x, double low, double high) {
  return x < low ? low - x : std::max(0.0, x - high);
}

/// Per kind, how many nodes more than there are the groups want.
std::vector<double> excess(const group_list& groups,
                           const std::vector<std::uint32_t>& chosen) {
  std::vector<double> more;
  for (const auto& nodes : groups.kinds)
    more.push_back(-static_cast<double>(nodes.size()));
  for (auto g : chosen)
    ++more[groups.of[g].kind];
  return more;
}

/// Keeps the prices moving where the bound is as good as the best total.
constexpr double least_missing = 1e-9;

} // namespace

slice_bound::slice_bound(const search_space& space, const group_list& groups)
    : space_(space), groups_(groups), all_((step_set{1} << space.steps()) - 1),
      cover_(space.steps()), weights_(groups.of.size()),
      lightest_(std::size_t{1} << space.steps()) {
  // nop
}

double slice_bound::weigh(const slice& one, const std::vector<double>& prices) {
  rebate_ = 0;
  for (std::size_t k = 0; k < prices.size(); ++k)
    rebate_ += prices[k] * static_cast<double>(groups_.kinds[k].size());
  cover_.begin(one.count);
  for (auto g : one.groups) {
    const auto& of = groups_.of[g];
    weights_[g] = of.cost / static_cast<double>(space_.steps())
                  + load_term(one, of) + prices[of.kind];
    if (cover_.offer(of.steps, weights_[g]))
      lightest_[of.steps] = g;
  }
  cover_.finish();
  return cover_.least(one.count, all_) - rebate_;
}

/// What the node adds to the load term at least, with the mean in the slice.
double slice_bound::load_term(const slice& one, const group& of) const {
  auto off = distance(of.load, one.low, one.high);
  return space_.asked.alpha * off * off / static_cast<double>(one.count);
}

std::vector<std::uint32_t> slice_bound::lightest(const slice& one) const {
  std::vector<std::uint32_t> chosen;
  for (auto set : cover_.cheapest(one.count, all_))
    chosen.push_back(lightest_[set]);
  return chosen;
}

void slice_bound::drop_useless(slice& one, double most_total) {
  cover_.finish_rest();
  const auto most = most_total + rebate_;
  auto is_useless = [&](std::uint32_t g) {
    auto rest = all_ ^ groups_.of[g].steps;
    return weights_[g] + cover_.least(one.count - 1, rest) > most;
  };
  one.groups.erase(
      std::remove_if(one.groups.begin(), one.groups.end(), is_useless),
      one.groups.end());
}

bool correct_prices(const group_list& groups,
                    const std::vector<std::uint32_t>& chosen, double missing,
                    std::vector<double>& prices) {
  const auto more = excess(groups, chosen);
  double length = 0;
  for (std::size_t k = 0; k < more.size(); ++k)
    if (more[k] > 0 || prices[k] > 0)
      length += more[k] * more[k];
  if (length == 0)
    return false;
  const auto pace = std::max(missing, least_missing) / length;
  for (std::size_t k = 0; k < more.size(); ++k)
    prices[k] = std::max(0.0, prices[k] + pace * more[k]);
  return true;
}

bool is_allocation(const group_list& groups,
                   const std::vector<std::uint32_t>& chosen) {
  const auto more = excess(groups, chosen);
  return std::all_of(more.begin(), more.end(),
                     [](double one) { return one <= 0; });
}

namespace {

std::size_t size_of(step_set steps) {
  std::size_t size = 0;
  for (; steps != 0; steps &= steps - 1)
    ++size;
  return size;
}

} // namespace

cover_bound::cover_bound(std::size_t steps)
    : steps_(steps), weights_(std::size_t{1} << steps), starting_at_(steps) {
  // nop
}

void cover_bound::begin(std::size_t most_groups) {
  width_ = most_groups + 1;
  std::fill(weights_.begin(), weights_.end(), infinity);
  least_.assign(weights_.size() * width_, infinity);
}

void cover_bound::finish() {
  for (auto& sets : starting_at_)
    sets.clear();
  for (step_set steps = 1; steps < weights_.size(); ++steps)
    if (weights_[steps] < infinity)
      starting_at_[first_of(steps)].push_back(steps);
  least_[0] = 0;
  for (step_set steps = 2; steps < weights_.size(); steps += 2)
    cover(steps);
  cover(all());
}

void cover_bound::finish_rest() {
  for (step_set steps = 1; steps < all(); steps += 2)
    cover(steps);
}

/// The group of the first step is one of the subsets that hold it, found in
/// the shorter of two lists. What it leaves has been covered before, being a
/// smaller number.
void cover_bound::cover(step_set steps) {
  const auto others = steps & (steps - 1);
  const auto& sets = starting_at_[first_of(steps)];
  const auto count = counts_of(steps);
  if (sets.size() < std::size_t{1} << (size_of(steps) - 1)) {
    for (auto set : sets)
      if ((set & ~steps) == 0)
        improve(steps, set, count);
    return;
  }
  for (auto left = others;; left = (left - 1) & others) {
    if (weights_[steps ^ left] < infinity)
      improve(steps, steps ^ left, count);
    if (left == 0)
      break;
  }
}

/// No more groups than steps, and enough to leave the steps outside of these
/// one each.
cover_bound::range cover_bound::counts_of(step_set steps) const {
  const auto outside = steps_ - size_of(steps);
  const auto most = width_ - 1;
  return {most > outside ? most - outside : 1, std::min(most, size_of(steps))};
}

void cover_bound::improve(step_set steps, step_set set, range count) {
  const auto weight = weights_[set];
  const auto* rest = &least_[(steps ^ set) * width_];
  auto* least = &least_[steps * width_];
  for (auto i = count.first; i <= count.last; ++i) {
    const auto sum = weight + rest[i - 1];
    least[i] = sum < least[i] ? sum : least[i];
  }
}

std::vector<step_set> cover_bound::cheapest(std::size_t count,
                                            step_set steps) const {
  std::vector<step_set> sets;
  for (; steps != 0; --count) {
    const auto others = steps & (steps - 1);
    auto left = others;
    // The same sum as in `cover`, so one of them is equal to the last bit.
    while (weights_[steps ^ left] + least(count - 1, left)
           != least(count, steps))
      left = (left - 1) & others;
    sets.push_back(steps ^ left);
    steps = left;
  }
  return sets;
}

} // namespace roscell::allocation
