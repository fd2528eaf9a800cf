#include "skills/engine/life/frame_text.hpp"

#include <chrono>

namespace roscell::engine {

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

} // namespace roscell::engine
