#pragma once

#include <array>
#include <cstddef>

/// The kinds of resources that a placement weighs, and how what is asked of
/// each compares with what is free.
namespace roscell::allocation {

/// Requests fit up to this much above what is free, and less than this much
/// free is nothing.
constexpr double tolerance = 1e-9;

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

} // namespace roscell::allocation
