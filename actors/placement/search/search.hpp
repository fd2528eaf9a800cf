#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/bounds/lower_bound.hpp"

#include <cstddef>
#include <optional>
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

/// Places each step in turn where the score so far is least. Nothing when a
/// step finds no room, which does not mean that there is none.
std::optional<assignment> greedy(const search_space& space);

/// Moves one step at a time to where the score falls most, until no move
/// helps. `guess` must fit.
assignment improved(const search_space& space, assignment guess, watch& until);

enum class verdict { fits, impossible, unknown };

struct feasibility {
  verdict what = verdict::unknown;
  /// When `fits`: a choice for each of the steps asked about, 0 for others.
  assignment found;
};

/// Whether the named steps can be placed together, whatever it costs. The
/// order of steps has no meaning here, so the hardest are placed first.
/// Unknown after `most_branches`, or when the watch says stop.
feasibility find_fit(const search_space& space,
                     const std::vector<std::size_t>& steps,
                     std::size_t most_branches, watch& until);

/// Out of steps that cannot be placed together, fewer that cannot: each step
/// is left out in turn, and stays out when the others still prove impossible
/// within a bounded effort.
std::vector<std::size_t> smallest_conflict(const search_space& space,
                                           std::vector<std::size_t> steps,
                                           watch& until);

} // namespace roscell::allocation
