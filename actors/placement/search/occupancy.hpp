#pragma once

#include "actors/placement/search/problem.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace roscell::allocation {

/// Requests fit up to this much above what is free, and less than this much
/// free is nothing.
constexpr double tolerance = 1e-9;

/// One way to place a step. `gpu` is the position in the node's list, or -1.
struct candidate {
  std::uint32_t node = 0;
  std::uint32_t deployment = 0;
  std::int32_t gpu = -1;
};

/// One resource from the view of one candidate: what it asks for, and what is
/// free for it, the denominator of equation (4).
struct share {
  double request = 0;
  double free = 0;

  bool fits() const {
    return request <= free + tolerance;
  }
  /// 0 without a request. 1 where nothing is free, which only a request below
  /// the tolerance can meet.
  double fraction() const {
    if (request <= 0)
      return 0;
    return free > tolerance ? request / free : 1;
  }
};

/// Positions in `shares::of`. GPU memory is there only for GPU deployments.
enum resource : std::size_t { cpu, memory, disk, gpu_memory };
constexpr std::size_t resource_count = 4;

/// The set R_i of one candidate.
struct shares {
  std::array<share, resource_count> of{};
  std::size_t count = 3;

  bool fit() const;
  /// Population variance of the fractions, as in equation (1).
  double variance() const;
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
