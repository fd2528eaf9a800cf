#include "actors/placement/search/bounds/cover_bound.hpp"

#include <algorithm>

namespace roscell::allocation {

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
