#pragma once

#include "actors/placement/search/problem.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace roscell::allocation {

/// Where a step runs. Positions in the problem; `gpu` is the index that the
/// node gives it, or -1.
struct seat {
  std::size_t node = 0;
  std::size_t deployment = 0;
  int gpu = -1;
};

/// One step that goes to another node.
struct step_move {
  std::size_t step = 0;
  seat to;
  double gain = 0; ///< What it takes off the total.
};

struct move_list {
  /// Why the problem was refused; empty: it was not.
  std::string message;
  score before;
  score after;
  /// No placement of the steps has a total below this.
  double lower_bound = 0;
  bool optimal = false; ///< None is better than `after`.
  std::vector<step_move> moves;
};

/// Which moves are worth making.
struct move_request {
  double min_gain = 0; ///< Of each one, as a part of the total at the start.
  std::size_t most = 0;
};

/// Steps that are not where a candidate is: they are to be taken out of the
/// problem, and their room is to be counted as in use.
std::vector<std::size_t> misplaced(const problem& asked,
                                   const std::vector<seat>& now);

/// Moves of one step each, the one with the most gain first, until none is
/// worth it: each fits while what it replaces still runs, and makes the total
/// of equation (1) better. A step moves once; steps that must share a node
/// stay. `asked` does not count the steps' own room as in use, and no step is
/// misplaced; the steps fit as they are.
move_list better_moves(const problem& asked, const std::vector<seat>& now,
                       const move_request& request, const limits& bounds = {});

} // namespace roscell::allocation
