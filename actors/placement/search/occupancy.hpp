#pragma once

#include "actors/placement/search/problem.hpp"
#include "actors/placement/search/resources.hpp"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace roscell::allocation {

/// One way to place a step. `gpu` is the position in the node's list, or -1.
struct candidate {
  std::uint32_t node = 0;
  std::uint32_t deployment = 0;
  std::int32_t gpu = -1;
};

/// What the steps placed so far take. Steps are placed in their order and
/// taken back in reverse, so what is free is what precedes a step leaves.
class occupancy {
public:
  /// What `place` changed, for `restore`: subtracting back would drift.
  struct saved {
    double cpu, memory, disk, gpu_memory, cpu_used, memory_used;
  };

  /// Keeps a reference to `asked`.
  explicit occupancy(const problem& asked);

  shares shares_of(const deployment& way, const candidate& choice) const;
  saved place(const deployment& way, const candidate& choice);
  void restore(const candidate& choice, const saved& before);

  /// Whether any step is placed on the node.
  bool hosts(std::size_t node) const {
    return rooms_[node].steps > 0;
  }
  /// The nodes V' that host a step, in the order of their first step. Sums
  /// over them do not depend on which of several equal nodes were taken.
  const std::vector<std::uint32_t>& used_nodes() const {
    return used_nodes_;
  }
  /// The load of a node, equation (2).
  double load(std::size_t node) const;
  /// The population variance of the load over V', 0 when it is empty.
  double load_variance() const;
  /// The most the load of a node rises when steps that ask for so many cores
  /// and MiB of memory go there, as far as they fit.
  double load_rise(std::size_t node, double cores, double mebibytes) const;

private:
  struct room {
    double cpu = 0, memory = 0, disk = 0; // free
    double cpu_used = 0, memory_used = 0; // as the load counts them
    std::size_t steps = 0;
    std::vector<double> gpus; // free memory
  };

  const problem& asked_;
  std::vector<room> rooms_;
  std::vector<std::uint32_t> used_nodes_;
};

} // namespace roscell::allocation
