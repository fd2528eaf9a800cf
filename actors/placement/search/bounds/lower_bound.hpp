#pragma once

#include "actors/placement/search/candidates.hpp"
#include "actors/placement/search/occupancy.hpp"
#include "actors/placement/search/problem.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roscell::allocation {

/// What the open steps, those from `depth` on, cost at least, given the
/// steps before them in an occupancy. docs/allocation.md has the proofs.
class lower_bound {
public:
  /// Keeps references to all three; `empty` is the occupancy without steps.
  /// About `row_work` candidates are looked at beforehand, for about 0.2 s at
  /// most; where that is too few for one row per depth, bounds are looser.
  lower_bound(const problem& asked, const candidate_set& candidates,
              const occupancy& empty, std::size_t row_work = 4'000'000);

  /// The least sum of variance and bonus of the steps from `first` on, when
  /// those from `depth` <= `first` on are open. Infinite when one of them has
  /// no candidate left that fits.
  double balance(const occupancy& now, std::size_t depth,
                 std::size_t first) const;

  /// What a step costs at least in any allocation.
  double least_cost(std::size_t step) const {
    return step_cost(empty_, 0, step);
  }

  /// The least load variance that the open steps can lead to.
  double load(const occupancy& now, std::size_t depth) const;

private:
  using amounts = std::array<double, resource_count>;
  struct choice_cost {
    double cost;
    std::uint32_t node;
  };

  void sum_up_most_taken();
  void fill_rows(std::size_t row_work);
  std::vector<choice_cost> cheapest_nodes(std::size_t depth, std::size_t step);
  double cost(const occupancy& now, std::size_t depth, std::size_t step,
              const candidate& choice) const;
  double cost_on(const occupancy& now, std::size_t depth, std::size_t step,
                 std::size_t node) const;
  double step_cost(const occupancy& now, std::size_t depth,
                   std::size_t step) const;
  double most_taken(std::size_t node, std::size_t from, std::size_t to,
                    std::size_t kind) const {
    return taken_[to][node][kind] - taken_[from][node][kind];
  }

  const problem& asked_;
  const candidate_set& candidates_;
  const occupancy& empty_;
  /// taken_[i][v]: the most that the steps before i can take of node v.
  std::vector<std::vector<amounts>> taken_;
  /// rows_[depth / stride_][i]: the nodes where step i costs least while
  /// none of them hosts a step yet, cheapest first.
  std::vector<std::vector<std::vector<choice_cost>>> rows_;
  std::size_t stride_ = 1;
};

/// A number known only to lie between two others.
struct interval {
  double low = 0;
  double high = 0;
};

/// The least sum of squared deviations from their mean that numbers within
/// these intervals can have. Since a mean minimises the squared deviations,
/// it is the minimum over t of the sum of squared distances from t to the
/// intervals, a convex and piecewise quadratic function. Takes time
/// quadratic in `count`.
double least_spread(const interval* of, std::size_t count);

} // namespace roscell::allocation
