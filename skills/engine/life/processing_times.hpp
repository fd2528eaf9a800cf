#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace roscell::engine {

/// How long `process` took, over the whole life of a skill. A histogram of
/// fixed size (8 KiB): each power of two of a nanosecond is split into 16
/// buckets of equal width, so a quantile is off by at most 1/32 of its value.
/// All members may be called from any thread.
class processing_times {
public:
  using duration = std::chrono::nanoseconds;

  void add(duration time);

  std::uint64_t count() const;

  /// The time that a share `q`, from 0 to 1, of all calls did not exceed; zero
  /// when there were none. `quantile(0.5)` is the median.
  duration quantile(double q) const;

private:
  mutable std::mutex mutex_;
  std::array<std::uint64_t, 976> buckets_{};
  std::uint64_t count_ = 0;
};

} // namespace roscell::engine
