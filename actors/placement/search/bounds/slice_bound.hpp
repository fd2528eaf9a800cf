#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/groups.hpp"

#include <cstddef>
#include <cstdint>
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

/// The allocations on `count` nodes with a mean load from `low` to `high` that
/// are made of these groups.
struct slice {
  std::size_t count = 0;
  double low = 0;
  double high = 0;
  double bound = 0;   // of the total
  bool tight = false; // its prices are good
  int rounds = 5;     // to correct the prices in
  /// Per kind, what an allocation pays for each of its nodes.
  std::vector<double> prices;
  std::vector<std::uint32_t> groups;
};

/// Weighs the groups of one slice at a time: the weights of an allocation's
/// groups, less the rebate, add up to no more than its total.
class slice_bound {
public:
  /// Keeps the references.
  slice_bound(const search_space& space, const group_list& groups);

  /// Weighs with these prices, one per kind of nodes. Returns a bound of the
  /// total of the allocations in the slice.
  double weigh(const slice& one, const std::vector<double>& prices);

  /// The groups of the lightest allocation, if two of them may want the same
  /// node. Only where the bound is finite.
  std::vector<std::uint32_t> lightest(const slice& one) const;

  /// Drops the groups that no allocation in the slice with a total up to
  /// `most_total` has. The slice must have been weighed last.
  void drop_useless(slice& one, double most_total);

  double weight(std::uint32_t group) const {
    return weights_[group];
  }
  double rebate() const {
    return rebate_;
  }
  /// What `count` groups that hold exactly the open steps weigh at least;
  /// with all steps open, or without step 0.
  double least(std::size_t count, step_set open) const {
    return cover_.least(count, open);
  }

private:
  double load_term(const slice& one, const group& of) const;

  const search_space& space_;
  const group_list& groups_;
  step_set all_;
  cover_bound cover_;
  std::vector<double> weights_;         // per group
  std::vector<std::uint32_t> lightest_; // group, per step_set
  double rebate_ = 0;
};

/// Corrects the prices of a slice by a step of the subgradient method: kinds of
/// which `chosen` wants too many nodes become dearer, and those with nodes to
/// spare cheaper. `missing` is how far the bound is from the best total. False
/// when nothing is left to change.
bool correct_prices(const group_list& groups,
                    const std::vector<std::uint32_t>& chosen, double missing,
                    std::vector<double>& prices);

/// Whether no kind has fewer nodes than the groups want of it.
bool is_allocation(const group_list& groups,
                   const std::vector<std::uint32_t>& chosen);

} // namespace roscell::allocation
