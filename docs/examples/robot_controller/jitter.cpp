#include "jitter.hpp"

#include <algorithm>

void jitter::add(std::chrono::nanoseconds late) {
  const auto us =
      std::chrono::duration_cast<std::chrono::microseconds>(late).count();
  const auto last = static_cast<long>(buckets_.size()) - 1;
  ++buckets_[static_cast<std::size_t>(std::clamp<long>(us, 0, last))];
  ++count_;
  worst_ = std::max(worst_, late);
}

std::chrono::microseconds jitter::quantile(double q) const {
  std::uint64_t left = 0;
  const auto wanted = static_cast<double>(count_) * q;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    left += buckets_[i];
    if (static_cast<double>(left) >= wanted)
      return std::chrono::microseconds{i};
  }
  return std::chrono::microseconds{buckets_.size()};
}
