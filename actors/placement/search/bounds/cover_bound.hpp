#pragma once

#include "actors/placement/search/groups.hpp"

#include <cstddef>
#include <vector>

namespace roscell::allocation {

/// The least weight of disjoint groups that hold given steps, where any two of
/// them may want the same node: a lower bound of what an allocation of these
/// steps weighs. Dynamic programming over subsets of steps.
class cover_bound {
public:
  explicit cover_bound(std::size_t steps);

  /// Forgets all weights; `most_groups` bounds `count` from now on.
  void begin(std::size_t most_groups);

  /// There is a group of these steps that weighs so much. Says whether it is
  /// the lightest of them so far.
  bool offer(step_set steps, double weight) {
    if (weight >= weights_[steps])
      return false;
    weights_[steps] = weight;
    return true;
  }

  /// To be called once all groups have been offered: finds the least weights
  /// of all steps and of every set without step 0. A choice of groups that
  /// takes the first open step each time leaves no other.
  void finish();

  /// The least weights of the other sets, which takes twice as long.
  void finish_rest();

  /// The least weight of exactly `count` groups that hold exactly `steps`;
  /// infinite when there are none, or when the other steps are too few for
  /// the groups that are missing to the number given to `begin`.
  double least(std::size_t count, step_set steps) const {
    return least_[steps * width_ + count];
  }

  /// The sets of such groups, the one with the first step first. Only where
  /// the least weight is finite.
  std::vector<step_set> cheapest(std::size_t count, step_set steps) const;

private:
  struct range {
    std::size_t first;
    std::size_t last;
  };

  step_set all() const {
    return static_cast<step_set>(weights_.size() - 1);
  }
  void cover(step_set steps);
  range counts_of(step_set steps) const;
  void improve(step_set steps, step_set set, range count);

  std::size_t steps_;
  std::size_t width_ = 0;
  std::vector<double> weights_;                    // per step_set
  std::vector<std::vector<step_set>> starting_at_; // those with a weight
  std::vector<double> least_;                      // per step_set and count
};

} // namespace roscell::allocation
