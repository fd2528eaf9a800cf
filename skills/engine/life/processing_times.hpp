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

  /// Upper bounds by which a node counts the frames of all its skills alike,
  /// so that those of several can be added.
  static constexpr std::array<std::uint64_t, 10> bounds_ms{
      1, 2, 5, 10, 20, 50, 100, 200, 500, 1000};

  /// All times in a few exact numbers that belong together.
  struct tally {
    std::uint64_t count = 0;
    std::uint64_t sum_ns = 0;
    /// How many lie up to each of `bounds_ms` and above the one before it; the
    /// last are those beyond all.
    std::array<std::uint64_t, bounds_ms.size() + 1> counts{};
  };

  void add(duration time);

  std::uint64_t count() const;

  tally tallied() const;

  /// The time that a share `q`, from 0 to 1, of all calls did not exceed; zero
  /// when there were none. `quantile(0.5)` is the median.
  duration quantile(double q) const;

private:
  mutable std::mutex mutex_;
  std::array<std::uint64_t, 976> buckets_{};
  tally tally_;
};

} // namespace roscell::engine
