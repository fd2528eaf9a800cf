#pragma once

#include "actors/placement/search/problem.hpp"

#include <random>
#include <string>

namespace roscell::bench {

/// How much the nodes of a cell differ in what they offer and what is used.
enum class variety { homogeneous, few_kinds, all_different };

const char* to_string(variety kind);

struct cell_shape {
  int steps = 1;
  int nodes = 1;
  variety kind = variety::all_different;
  bool tight = false; ///< Most of every node is used, and steps ask for more.
  bool gpus = false;  ///< A third of the nodes have GPUs, and each step can
                      ///< run on one.
};

/// A random cell and request. Equal arguments give equal problems.
allocation::problem make_problem(const cell_shape& shape, unsigned seed);

} // namespace roscell::bench
