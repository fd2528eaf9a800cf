#include "skills/engine/life/processing_times.hpp"

#include <algorithm>
#include <chrono>
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

namespace {

std::string us(processing_times::duration time) {
  using std::chrono::microseconds;
  return std::to_string(std::chrono::duration_cast<microseconds>(time).count());
}

} // namespace

std::string frame_text(const processing_times& times, std::uint64_t dropped,
                       std::uint64_t failed) {
  constexpr std::uint64_t ns_in_us = 1000;
  const auto all = times.tallied();
  auto result = "frames=" + std::to_string(all.count) + " dropped="
                + std::to_string(dropped) + " failed=" + std::to_string(failed)
                + " median_us=" + us(times.quantile(0.5))
                + " p99_us=" + us(times.quantile(0.99))
                + " times_us=" + std::to_string(all.sum_ns / ns_in_us);
  const char* before = " times=";
  for (const auto count : all.counts) {
    result += before + std::to_string(count);
    before = ",";
  }
  return result;
}

namespace {

/// The first frames of a camera may overtake what is needed to use them.
constexpr std::uint64_t patient_frames = 10;

} // namespace

input_work::input_work(const std::vector<std::string>& data_types) {
  for (const auto& type : data_types)
    inputs_.emplace_back().data_type = type;
  if (!data_types.empty())
    main_type_ = data_types.front();
}

void input_work::set_main(std::size_t input) {
  std::lock_guard guard{mutex_};
  main_type_ = inputs_.at(input).data_type;
}

bool input_work::is_main(std::size_t input) const {
  std::lock_guard guard{mutex_};
  return inputs_[input].data_type == main_type_;
}

void input_work::add(std::size_t input, const handled_frame& x) {
  std::lock_guard guard{mutex_};
  auto& to = inputs_[input];
  to.failed += x.failed ? 1 : 0;
  to.failed_in_row = x.failed ? to.failed_in_row + 1 : 0;
  to.fruitless = x.results == 0 ? to.fruitless + 1 : 0;
  to.was_fruitful = to.was_fruitful || x.results > 0;
  to.reason = x.reason;
  if (x.failed)
    return;
  to.times.add(x.time);
  if (to.data_type == main_type_)
    main_times_.add(x.time);
}

std::uint64_t input_work::failed(std::size_t input) const {
  std::lock_guard guard{mutex_};
  return inputs_[input].failed;
}

std::uint64_t input_work::failed_in_row(std::size_t input) const {
  std::lock_guard guard{mutex_};
  return inputs_[input].failed_in_row;
}

std::string input_work::remark() const {
  std::lock_guard guard{mutex_};
  for (const auto& x : inputs_) {
    if (x.data_type != main_type_ || x.fruitless < patient_frames
        || (x.was_fruitful && x.reason.empty()))
      continue;
    return std::to_string(x.fruitless) + " frames in"
           + (x.was_fruitful ? " since the last one out" : ", none out")
           + (x.reason.empty() ? "" : ": " + x.reason);
  }
  return {};
}

} // namespace roscell::engine
