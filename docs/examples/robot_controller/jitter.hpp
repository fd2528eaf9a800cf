#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

/// How late the cycles of a loop began, in buckets of 1 us up to 10 ms. Adding
/// takes neither locks nor memory.
class jitter {
public:
  void add(std::chrono::nanoseconds late);

  /// The lateness that a share `q`, from 0 to 1, of the cycles did not exceed.
  std::chrono::microseconds quantile(double q) const;

  std::chrono::nanoseconds worst() const {
    return worst_;
  }

private:
  std::array<std::uint32_t, 10'000> buckets_{};
  std::uint64_t count_ = 0;
  std::chrono::nanoseconds worst_{0};
};
