#pragma once

#include "actors/core/limits.hpp"

#include <algorithm>
#include <chrono>
#include <random>

namespace roscell {

/// Ever longer pauses between attempts, with jitter so that the many members
/// of a coordinator that returns do not all come at once.
class backoff {
public:
  using duration = std::chrono::milliseconds;

  explicit backoff(uint32_t seed = 1) : random_(seed) {}

  /// The pause before the next attempt: half to all of the present step.
  duration next() {
    const auto step = step_;
    step_ = std::min(2 * step, limits::retry::longest);
    std::uniform_real_distribution<double> part{0.5, 1.0};
    return std::chrono::duration_cast<duration>(part(random_) * step);
  }

  void reset() {
    step_ = limits::retry::first;
  }

private:
  duration step_ = limits::retry::first;
  std::minstd_rand random_;
};

} // namespace roscell
