#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace roscell::allocation {

/// The fractions of equation (4): what a step takes of what is free for it.
struct fractions {
  double cpu = 0;
  double memory = 0;
  double disk = 0;
  /// Only where the deployment needs a GPU.
  std::optional<double> gpu_memory;
};

/// Where one step goes, and what that costs. `node` and `deployment` are
/// positions in the problem, `gpu` is the index the node gives its GPU, or -1.
struct placement {
  std::size_t step = 0;
  std::size_t node = 0;
  std::size_t deployment = 0;
  int gpu = -1;
  fractions shares;
  double variance = 0;
  double bonus = 0;
};

/// The objective of equation (1): total = balance + alpha * load.
struct score {
  double total = 0;
  double balance = 0;
  double load = 0;
};

enum class reason_kind {
  skill,        ///< The node does not have the skill.
  architecture, ///< The deployment does not run on the node's architecture.
  label,        ///< The node lacks a label.
  device,       ///< The node lacks a device.
  gpu,          ///< The node has no GPU.
  cpu,          ///< Too few cores are free.
  memory,       ///< Too little memory is free.
  disk,         ///< Too little disk is free.
  gpu_memory,   ///< Too little memory is free on the GPU.
  combination,  ///< It fits alone, but the steps do not fit together.
  excluded,     ///< The problem says that it may not be taken.
};

/// The word for a kind of reason, as it is spelled above.
const char* to_string(reason_kind kind);

/// Why a candidate is not taken. The numbers are 0 where none is short; they
/// are in cores or MiB like the resource that `text` names.
struct reason {
  reason_kind kind = reason_kind::skill;
  double needed = 0;
  double free = 0;
  double short_by = 0;
  std::string text;
};

/// A candidate that cannot be used, with every reason against it. `gpu` is -1
/// for a deployment without a GPU and for a node that has none.
struct rejected_candidate {
  std::size_t step = 0;
  std::size_t node = 0;
  std::size_t deployment = 0;
  int gpu = -1;
  std::vector<reason> reasons;
};

enum class outcome {
  optimal,    ///< The allocation that the tie rule picks among the minima.
  best_found, ///< Stopped early: a valid allocation, and a proven bound.
  infeasible, ///< Proven: no allocation of all steps exists.
  undecided,  ///< Stopped early, before any allocation was found.
  invalid,    ///< The problem was refused; `message` names the place.
};

struct result {
  outcome what = outcome::invalid;
  /// One per step, in their order; empty unless `has_allocation()`.
  std::vector<placement> placements;
  score value;
  /// No allocation has a total below this. Equal to the total when optimal,
  /// infinite when infeasible.
  double lower_bound = -std::numeric_limits<double>::infinity();
  /// Candidates that cannot be used even alone, in the order of steps, nodes,
  /// deployments and GPU indices. When infeasible, all other candidates follow
  /// in the same order, so that each one is explained.
  std::vector<rejected_candidate> rejected;
  /// When infeasible: steps that cannot be placed together, the fewest found.
  std::vector<std::size_t> conflict;
  std::vector<std::string> warnings;
  /// A sentence for people; empty when there is an optimal allocation.
  std::string message;
  /// Branches looked at, for measurements.
  std::size_t expanded = 0;

  bool optimal() const {
    return what == outcome::optimal;
  }
  bool has_allocation() const {
    return what == outcome::optimal || what == outcome::best_found;
  }
};

} // namespace roscell::allocation
