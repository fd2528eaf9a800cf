#include "actors/core/backoff.hpp"

#include "actors/core/limits.hpp"

#include <algorithm>

namespace roscell {

backoff::backoff(uint32_t seed) : step_{limits::retry::first}, random_(seed) {}

backoff::duration backoff::next() {
  const auto step = step_;
  step_ = std::min(2 * step, limits::retry::longest);
  std::uniform_real_distribution<double> part{0.5, 1.0};
  return std::chrono::duration_cast<duration>(part(random_) * step);
}

void backoff::reset() {
  step_ = limits::retry::first;
}

} // namespace roscell
