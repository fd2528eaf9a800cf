#pragma once

#include <chrono>
#include <cstdint>
#include <random>

namespace roscell {

/// Ever longer pauses between attempts, with jitter so that the many members
/// of a coordinator that returns do not all come at once.
class backoff {
public:
  using duration = std::chrono::milliseconds;

  explicit backoff(uint32_t seed = 1);

  /// The pause before the next attempt: half to all of the present step.
  duration next();

  void reset();

private:
  duration step_;
  std::minstd_rand random_;
};

} // namespace roscell
