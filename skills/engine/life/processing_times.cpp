#include "skills/engine/life/processing_times.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace roscell::engine {

namespace {

/// A value below 16 has a bucket of its own. Above, the bucket is given by the
/// position of the highest bit and the four bits below it.
std::size_t bucket_of(std::uint64_t value) {
  if (value < 16)
    return value;
  auto high = 63 - __builtin_clzll(value);
  auto top_bits = value >> (high - 4);
  return static_cast<std::size_t>(high - 4) * 16 + top_bits;
}

/// The middle of a bucket.
std::uint64_t value_of(std::size_t bucket) {
  if (bucket < 16)
    return bucket;
  auto shift = bucket / 16 - 1;
  auto least = static_cast<std::uint64_t>(16 + bucket % 16) << shift;
  return least + ((std::uint64_t{1} << shift) - 1) / 2;
}

std::size_t place_among_bounds(std::uint64_t value_ns) {
  constexpr std::uint64_t ns_in_ms = 1'000'000;
  const auto& bounds = processing_times::bounds_ms;
  const auto bound = std::find_if(bounds.begin(), bounds.end(), [&](auto ms) {
    return value_ns <= ms * ns_in_ms;
  });
  return static_cast<std::size_t>(bound - bounds.begin());
}

} // namespace

void processing_times::add(duration time) {
  const auto value_ns =
      static_cast<std::uint64_t>(std::max<duration::rep>(time.count(), 0));
  std::lock_guard guard{mutex_};
  ++buckets_.at(bucket_of(value_ns));
  ++tally_.count;
  tally_.sum_ns += value_ns;
  ++tally_.counts.at(place_among_bounds(value_ns));
}

std::uint64_t processing_times::count() const {
  std::lock_guard guard{mutex_};
  return tally_.count;
}

processing_times::tally processing_times::tallied() const {
  std::lock_guard guard{mutex_};
  return tally_;
}

processing_times::duration processing_times::quantile(double q) const {
  std::lock_guard guard{mutex_};
  auto share =
      std::ceil(std::clamp(q, 0.0, 1.0) * static_cast<double>(tally_.count));
  auto rank = std::max<std::uint64_t>(static_cast<std::uint64_t>(share), 1);
  std::uint64_t below = 0;
  for (std::size_t i = 0; i < buckets_.size(); ++i) {
    below += buckets_[i];
    if (below >= rank)
      return duration{value_of(i)};
  }
  return duration{0};
}

} // namespace roscell::engine
