#pragma once

#include "actors/placement/search/assignment.hpp"
#include "actors/placement/search/bounds/slice_bound.hpp"
#include "actors/placement/search/groups.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roscell::allocation {

/// Finds the optimum as a choice of groups. All allocations are cut into
/// slices by how many nodes they use and by their mean load; within a slice
/// the weights of groups add up. docs/allocation.md has the proof. Two passes,
/// as in `search`.
class group_search {
public:
  /// Keeps the references. `start` must fit, and `groups` must be those of a
  /// total not below its total. `least` is below every total.
  group_search(const search_space& space, const group_list& groups,
               const assignment& start, double least, watch& until);

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
  void work_off(std::vector<slice> slices);
  bool work_on(slice& one);
  void leave(const slice& one);
  void tighten(slice& one);
  void take(const std::vector<std::uint32_t>& groups);
  void sort_groups(const slice& one);
  void dive(step_set open, std::size_t left, double sum);
  void try_group(std::uint32_t chosen, step_set open, std::size_t left,
                 double sum);
  void push(std::uint32_t chosen);
  void pop();
  void reach_end();
  double quick_total() const;
  bool is_late(step_set open) const;
  bool prunes(double bound) const;
  double loosest() const;

  const search_space& space_;
  const group_list& groups_;
  watch& until_;
  slice_bound bound_;
  std::vector<slice> done_; // by the first pass, for the second one
  std::vector<std::vector<std::uint32_t>> starting_at_; // per step
  std::vector<std::uint32_t> chosen_;
  std::vector<std::size_t> used_; // nodes per kind
  assignment current_;
  assignment best_;
  double best_total_;
  double least_;
  double proven_;
  double scale_;
  std::size_t effort_ = 0;
  std::size_t most_effort_ = 0;
  bool settling_ = false;
};

} // namespace roscell::allocation
