#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/bounds/lower_bound.hpp"
#include "actors/placement/search/watch.hpp"

#include <cstddef>
#include <vector>

namespace roscell::allocation {

/// Allocations this close to the minimum tie.
constexpr double tie_width = 1e-12;

/// Depth-first branch and bound over the steps in their order, in two passes:
/// `minimise` finds the least total and proves it; `settle_tie` then finds
/// the first of all assignments that tie with it.
class search {
public:
  /// Keeps the references. `start` must fit.
  search(const search_space& space, const lower_bound& bound,
         const assignment& start, watch& until);

  void minimise();

  /// To be called once `minimise` has ended without a stop. A stop leaves the
  /// best assignment as it was.
  void settle_tie();

  const assignment& best() const {
    return best_;
  }
  /// No assignment has a lower total. The best total unless stopped.
  double proven() const {
    return proven_;
  }

private:
  struct branch {
    std::size_t position; // among the step's candidates
    double sum;           // of variance and bonus, this step included
    double bound;         // of the total
  };

  void visit(std::size_t depth, double sum);
  void visit_branches(std::size_t depth);
  void list_branches(std::size_t depth, double sum);
  void reach_end(double sum);
  bool prunes(double bound) const;
  double total_at_least(double sum, double load) const;

  const search_space& space_;
  const lower_bound& bound_;
  watch& until_;
  occupancy now_;
  std::vector<std::vector<branch>> branches_; // per depth
  assignment current_;
  assignment best_;
  double best_total_;
  double proven_;
  bool settling_ = false;
  bool done_ = false;
};

} // namespace roscell::allocation
